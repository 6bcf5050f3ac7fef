//! Core sensors: stamp, bumper, cliff, wheel drop, encoders, buttons, charger, battery.

use super::fields::{Fields, bits, byte_of};
use trundle_core::{PerWheel, PowerSource};

/// Units of the battery's byte in a volt: 10. Source: the protocol's "Basic Sensor Data".
const BATTERY_UNITS_PER_V: f64 = 10.0;
/// Bit of the charger's byte: power comes in. Source: the five values of the protocol, 0, 2, 6, 18 and 22.
const CHARGER_POWERED_BIT: u8 = 0b0_0010;
/// Bit of the charger's byte: the battery is being charged. Source: as [`CHARGER_POWERED_BIT`].
const CHARGER_CHARGING_BIT: u8 = 0b0_0100;
/// Bit of the charger's byte: the power comes from the adapter. Source: as [`CHARGER_POWERED_BIT`].
const CHARGER_ADAPTER_BIT: u8 = 0b1_0000;

/// A flag of three sensors at the front.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ThreeSides {
    /// The left one.
    pub left: bool,
    /// The one in the middle.
    pub center: bool,
    /// The right one.
    pub right: bool,
}

impl ThreeSides {
    /// Whether any of the three flags is set.
    pub fn any(&self) -> bool {
        self.left || self.center || self.right
    }

    fn from_byte(byte: u8) -> Self {
        let [right, center, left] = bits(u16::from(byte));
        Self { left, center, right }
    }

    fn byte(self) -> u8 {
        byte_of(&[self.right, self.center, self.left])
    }
}

/// State of the charger.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Charger {
    /// Source of the power.
    pub source: PowerSource,
    /// Whether the battery is being charged.
    pub is_charging: bool,
}

impl Charger {
    fn from_byte(byte: u8) -> Self {
        let source = match (byte & CHARGER_ADAPTER_BIT != 0, byte & CHARGER_POWERED_BIT != 0) {
            (true, _) => PowerSource::Adapter,
            (false, true) => PowerSource::ChargingStation,
            (false, false) => PowerSource::Battery,
        };
        Self { source, is_charging: byte & CHARGER_CHARGING_BIT != 0 }
    }

    fn byte(self) -> u8 {
        let source = match self.source {
            PowerSource::Battery => 0,
            PowerSource::ChargingStation => CHARGER_POWERED_BIT,
            PowerSource::Adapter => CHARGER_POWERED_BIT | CHARGER_ADAPTER_BIT,
        };
        source | if self.is_charging { CHARGER_CHARGING_BIT } else { 0 }
    }
}

/// Sub-payload 1, in every packet.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CoreSensors {
    /// The base's clock, ms; wraps at 65536.
    pub stamp_ms: u16,
    /// Pressed bumpers.
    pub bumper: ThreeSides,
    /// Wheels that hang.
    pub wheel_drop: PerWheel,
    /// Cliff sensors with no floor below.
    pub cliff: ThreeSides,
    /// Encoder of the left wheel, ticks, forward positive; wraps at 65536.
    pub left_ticks: u16,
    /// Encoder of the right wheel, ticks, forward positive; wraps at 65536.
    pub right_ticks: u16,
    /// Duty of the left motor, -128 to 127, backward negative.
    pub left_pwm: i8,
    /// Duty of the right motor, -128 to 127, backward negative.
    pub right_pwm: i8,
    /// Pressed buttons, B0 first.
    pub buttons: [bool; 3],
    /// Charger.
    pub charger: Charger,
    /// Voltage of the battery, in 0.1 V; see [`CoreSensors::battery_v`].
    pub battery_decivolts: u8,
    /// Wheel motors with too much current.
    pub over_current: PerWheel,
}

impl CoreSensors {
    /// Voltage of the battery, V.
    pub fn battery_v(&self) -> f64 {
        f64::from(self.battery_decivolts) / BATTERY_UNITS_PER_V
    }

    pub(super) fn decode(mut data: Fields<'_>) -> Option<Self> {
        let stamp_ms = data.u16()?;
        let bumper = ThreeSides::from_byte(data.u8()?);
        let [drop_right, drop_left] = bits(u16::from(data.u8()?));
        let cliff = ThreeSides::from_byte(data.u8()?);
        let (left_ticks, right_ticks) = (data.u16()?, data.u16()?);
        let (left_pwm, right_pwm) = (data.i8()?, data.i8()?);
        let buttons = bits(u16::from(data.u8()?));
        let charger = Charger::from_byte(data.u8()?);
        let battery_decivolts = data.u8()?;
        let [over_left, over_right] = bits(u16::from(data.u8()?));
        Some(Self {
            stamp_ms,
            bumper,
            wheel_drop: PerWheel { left: drop_left, right: drop_right },
            cliff,
            left_ticks,
            right_ticks,
            left_pwm,
            right_pwm,
            buttons,
            charger,
            battery_decivolts,
            over_current: PerWheel { left: over_left, right: over_right },
        })
    }

    pub(super) fn data(&self) -> Vec<u8> {
        let mut data = self.stamp_ms.to_le_bytes().to_vec();
        data.push(self.bumper.byte());
        data.push(byte_of(&[self.wheel_drop.right, self.wheel_drop.left]));
        data.push(self.cliff.byte());
        data.extend(self.left_ticks.to_le_bytes());
        data.extend(self.right_ticks.to_le_bytes());
        data.extend(self.left_pwm.to_le_bytes());
        data.extend(self.right_pwm.to_le_bytes());
        data.extend([byte_of(&self.buttons), self.charger.byte(), self.battery_decivolts]);
        data.push(byte_of(&[self.over_current.left, self.over_current.right]));
        data
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_flag_has_its_bit() {
        let only = |at: usize, byte: u8| {
            let mut data = [0; 15];
            data[at] = byte;
            CoreSensors::decode(Fields(&data)).unwrap()
        };
        let left = ThreeSides { left: true, ..ThreeSides::default() };
        let right = ThreeSides { right: true, ..ThreeSides::default() };
        assert_eq!((only(2, 4).bumper, only(2, 1).bumper), (left, right));
        assert!(only(2, 2).bumper.center && only(4, 2).cliff.center);
        assert_eq!((only(4, 4).cliff, only(4, 1).cliff), (left, right));
        let (left, right) = (PerWheel { left: true, right: false }, PerWheel { left: false, right: true });
        assert_eq!((only(3, 2).wheel_drop, only(3, 1).wheel_drop), (left, right));
        assert_eq!((only(14, 1).over_current, only(14, 2).over_current), (left, right));
        assert_eq!(only(11, 4).buttons, [false, false, true]);
        assert_eq!((only(9, 0xFE).left_pwm, only(10, 0xFF).right_pwm), (-2, -1));
    }

    #[test]
    fn the_charger_has_five_states() {
        let states = [
            (0, PowerSource::Battery, false),
            (2, PowerSource::ChargingStation, false),
            (6, PowerSource::ChargingStation, true),
            (18, PowerSource::Adapter, false),
            (22, PowerSource::Adapter, true),
        ];
        for (byte, source, is_charging) in states {
            let charger = Charger { source, is_charging };
            assert_eq!((Charger::from_byte(byte), charger.byte()), (charger, byte));
        }
    }
}

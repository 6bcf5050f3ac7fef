//! `sensor_msgs/BatteryState`.

use super::stamp;
use crate::generated::sensor_msgs::BatteryState;
use trundle_core::{Battery, Invalid, PowerSource, Stamp, require_in};

/// The battery as a message. Unknown quantities are NaN, as the message's definition requires.
#[must_use]
pub fn to_ros(battery: &Battery, at: Stamp, frame: &str) -> BatteryState {
    let is_on_charger = battery.source != PowerSource::Battery;
    let power_supply_status = match (battery.is_charging, is_on_charger) {
        (true, _) => BatteryState::POWER_SUPPLY_STATUS_CHARGING,
        (false, true) => BatteryState::POWER_SUPPLY_STATUS_NOT_CHARGING,
        (false, false) => BatteryState::POWER_SUPPLY_STATUS_DISCHARGING,
    };
    BatteryState {
        header: stamp::header(at, frame),
        voltage: battery.voltage_v as f32,
        percentage: battery.charge.map_or(f32::NAN, |charge| charge as f32),
        power_supply_status,
        temperature: f32::NAN,
        current: f32::NAN,
        charge: f32::NAN,
        capacity: f32::NAN,
        design_capacity: f32::NAN,
        present: true,
        ..BatteryState::default()
    }
}

/// The battery of a message.
///
/// # Errors
/// When the voltage is not 0 to 1000 V, or the charge is known and not 0 to 1.
pub fn from_ros(message: &BatteryState) -> Result<Battery, Invalid> {
    let voltage_v = require_in("voltage", f64::from(message.voltage), "V", 0.0, 1000.0)?;
    let charge = f64::from(message.percentage);
    let charge = if charge.is_nan() { None } else { Some(require_in("percentage", charge, "", 0.0, 1.0)?) };
    let status = message.power_supply_status;
    let is_charging = status == BatteryState::POWER_SUPPLY_STATUS_CHARGING;
    let is_on_charger = is_charging || status == BatteryState::POWER_SUPPLY_STATUS_FULL;
    let source = if is_on_charger { PowerSource::ChargingStation } else { PowerSource::Battery };
    Ok(Battery { voltage_v, charge, source, is_charging })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batteries_go_there_and_back() {
        let own = Battery {
            voltage_v: 14.5,
            charge: Some(0.5),
            source: PowerSource::ChargingStation,
            is_charging: true,
        };
        let mut message = to_ros(&own, Stamp::default(), "base_link");
        assert_eq!(from_ros(&message).unwrap(), own);
        message.percentage = 55.0;
        assert!(from_ros(&message).unwrap_err().to_string().starts_with("percentage is 55"));
        message.voltage = f32::NAN;
        assert!(from_ros(&message).unwrap_err().to_string().starts_with("voltage is NaN"));
    }
}

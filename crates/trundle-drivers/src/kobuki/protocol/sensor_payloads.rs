//! Sub-payloads of single sensors: docking light, inertia, cliff signals, motor currents, raw gyro, inputs.

use super::fields::{Fields, bits, byte_of};
use trundle_core::{DockBeams, DockInfrared};

/// Turn rate of a unit of the raw gyro: 0.00875 deg/s. Source: the data sheet of the L3G4200D at 250 deg/s full scale.
const GYRO_UNIT_DEG_S: f64 = 0.008_75;
/// Angle of a unit of the inertial sensor: 0.01 deg. Source: the vendor's driver.
const INERTIA_UNIT_DEG: f64 = 0.01;
/// Current of a unit of the motor currents: 0.01 A. Source: the protocol's "Current".
const CURRENT_UNIT_A: f64 = 0.01;

/// Reads the bytes of the receivers: right, centre, left.
pub(super) fn decode_dock(mut data: Fields<'_>) -> Option<DockInfrared> {
    let mut beams = || data.u8().map(beams_of);
    let (right, center, left) = (beams()?, beams()?, beams()?);
    Some(DockInfrared { left, center, right })
}

/// The bytes of the receivers: right, centre, left.
pub(super) fn dock_data(dock: &DockInfrared) -> Vec<u8> {
    [dock.right, dock.center, dock.left].map(byte_of_beams).to_vec()
}

fn beams_of(byte: u8) -> DockBeams {
    let [near_left, near_center, near_right, far_center, far_left, far_right] = bits(u16::from(byte));
    DockBeams { near_left, near_center, near_right, far_left, far_center, far_right }
}

fn byte_of_beams(beams: DockBeams) -> u8 {
    let DockBeams { near_left, near_center, near_right, far_left, far_center, far_right } = beams;
    byte_of(&[near_left, near_center, near_right, far_center, far_left, far_right])
}

/// Sub-payload 4: heading and turn rate, calibrated by the firmware.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Inertia {
    /// Heading in 0.01 deg, counter-clockwise, -18000 to 18000.
    pub angle_centideg: i16,
    /// Turn rate in 0.01 deg/s, counter-clockwise.
    pub rate_centideg_s: i16,
}

impl Inertia {
    /// Heading since the base was switched on, rad, counter-clockwise.
    pub fn angle(&self) -> f64 {
        (f64::from(self.angle_centideg) * INERTIA_UNIT_DEG).to_radians()
    }

    /// Turn rate, rad/s, counter-clockwise, without the firmware's own bias estimate.
    pub fn rate(&self) -> f64 {
        (f64::from(self.rate_centideg_s) * INERTIA_UNIT_DEG).to_radians()
    }

    /// The values nearest to an angle (rad, -pi to pi) and a turn rate (rad/s), counter-clockwise.
    pub fn nearest(angle: f64, rate: f64) -> Self {
        let centideg = |radians: f64| (radians.to_degrees() / INERTIA_UNIT_DEG).round() as i16;
        Self { angle_centideg: centideg(angle), rate_centideg_s: centideg(rate) }
    }

    pub(super) fn decode(mut data: Fields<'_>) -> Option<Self> {
        Some(Self { angle_centideg: data.i16()?, rate_centideg_s: data.i16()? })
    }

    pub(super) fn data(self) -> Vec<u8> {
        let [angle, rate] = [self.angle_centideg, self.rate_centideg_s].map(i16::to_le_bytes);
        [&angle[..], &rate, &[0; 3]].concat()
    }
}

/// Sub-payload 5: signals of the cliff sensors, 0 to 4095 for 0 to 3.3 V; higher is nearer, not linear.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CliffSignals {
    /// Right sensor.
    pub right: u16,
    /// Sensor in the middle.
    pub center: u16,
    /// Left sensor.
    pub left: u16,
}

impl CliffSignals {
    pub(super) fn decode(mut data: Fields<'_>) -> Option<Self> {
        Some(Self { right: data.u16()?, center: data.u16()?, left: data.u16()? })
    }

    pub(super) fn data(self) -> Vec<u8> {
        [self.right, self.center, self.left].map(u16::to_le_bytes).concat()
    }
}

/// Sub-payload 6: currents of the wheel motors.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct MotorCurrents {
    /// Left motor, in 10 mA.
    pub left: u8,
    /// Right motor, in 10 mA.
    pub right: u8,
}

impl MotorCurrents {
    /// Currents of the left and right motor, A.
    pub fn amperes(&self) -> [f64; 2] {
        [self.left, self.right].map(|units| f64::from(units) * CURRENT_UNIT_A)
    }

    pub(super) fn decode(mut data: Fields<'_>) -> Option<Self> {
        Some(Self { left: data.u8()?, right: data.u8()? })
    }
}

/// Sub-payload 13: raw readings of the three-axis gyro since the last packet, two or three.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RawGyro {
    /// Number of the first reading; wraps at 256.
    pub frame_id: u8,
    /// Readings in time order: x, y, z of the sensor, in 0.00875 deg/s.
    pub readings: Vec<[i16; 3]>,
}

impl RawGyro {
    /// Turn rates of the base, rad/s, with the sensor's bias: x forward, y left, z up. The sensor is turned by 90 deg around z.
    pub fn rates(&self) -> impl ExactSizeIterator<Item = [f64; 3]> + '_ {
        let rate = |raw: i16| (f64::from(raw) * GYRO_UNIT_DEG_S).to_radians();
        self.readings.iter().map(move |[x, y, z]| [-rate(*y), rate(*x), rate(*z)])
    }

    /// The raw number nearest to a turn rate around z, rad/s; clamped to the sensor's 16 bits.
    pub fn nearest_z(rate: f64) -> i16 {
        (rate.to_degrees() / GYRO_UNIT_DEG_S).round() as i16
    }

    /// Reads as many readings as both the count and the data hold.
    pub(super) fn decode(mut data: Fields<'_>) -> Option<Self> {
        let (frame_id, numbers) = (data.u8()?, data.u8()?);
        let reading = |_| Some([data.i16()?, data.i16()?, data.i16()?]);
        Some(Self { frame_id, readings: (0..numbers / 3).map_while(reading).collect() })
    }

    pub(super) fn data(&self) -> Vec<u8> {
        let numbers = (3 * self.readings.len()).min(usize::from(u8::MAX)) as u8;
        let readings = self.readings.iter().flatten().flat_map(|number| number.to_le_bytes());
        [self.frame_id, numbers].into_iter().chain(readings).collect()
    }
}

/// Sub-payload 16: inputs of the expansion port.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct GeneralInputs {
    /// Digital inputs 0 to 3: high voltage.
    pub digital: [bool; 4],
    /// Analog inputs 0 to 3: 0 to 4095 for 0 to 3.3 V.
    pub analog: [u16; 4],
}

impl GeneralInputs {
    pub(super) fn decode(mut data: Fields<'_>) -> Option<Self> {
        let digital = bits(data.u16()?);
        Some(Self { digital, analog: [data.u16()?, data.u16()?, data.u16()?, data.u16()?] })
    }

    pub(super) fn data(self) -> Vec<u8> {
        let analog = self.analog.map(u16::to_le_bytes).concat();
        [&[byte_of(&self.digital), 0][..], &analog, &[0; 6]].concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beams_have_their_bits_and_receivers_their_order() {
        let dock = decode_dock(Fields(&[1, 8, 16 + 32])).unwrap();
        assert_eq!(dock.right, DockBeams { near_left: true, ..DockBeams::default() });
        assert_eq!(dock.center, DockBeams { far_center: true, ..DockBeams::default() });
        assert_eq!(dock.left, DockBeams { far_left: true, far_right: true, ..DockBeams::default() });
        assert_eq!(dock_data(&dock), [1, 8, 48]);
        assert!(decode_dock(Fields(&[2, 4, 0])).unwrap().center.near_right);
    }

    #[test]
    fn the_gyro_is_turned_by_a_right_angle() {
        let gyro = RawGyro { frame_id: 3, readings: vec![[100, 200, 300], [0, 0, -1]] };
        let degrees: Vec<_> = gyro.rates().map(|rates| rates.map(f64::to_degrees)).collect();
        assert!((degrees[0][0] + 1.75).abs() < 1e-12 && (degrees[0][1] - 0.875).abs() < 1e-12);
        assert!((degrees[0][2] - 2.625).abs() < 1e-12 && (degrees[1][2] + 0.00875).abs() < 1e-12);
        assert_eq!(RawGyro::nearest_z(2.625f64.to_radians()), 300);
        assert_eq!(RawGyro::decode(Fields(&gyro.data())), Some(gyro));
    }

    #[test]
    fn a_gyro_count_beyond_the_data_reads_what_is_there() {
        let gyro = RawGyro::decode(Fields(&[9, 9, 1, 0, 2, 0, 3, 0, 4, 0])).unwrap();
        assert_eq!(gyro.readings, [[1, 2, 3]]);
    }
}

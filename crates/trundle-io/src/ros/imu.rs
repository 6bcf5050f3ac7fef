//! `sensor_msgs/Imu`: the turn rate around the vertical.

use super::cdr::{CdrError, CdrReader, Wire};
use super::message::NOT_MEASURED;
use super::messages::{header, types};
use nalgebra::UnitQuaternion;
use trundle_core::{GyroRate, Invalid, Stamp, Vector3, require_finite, require_in};

/// Largest turn rate of a reading, rad/s: 2000 deg/s, the range of the usual gyros. Source: data sheets of BMI055, ICM-20948, LSM6DS.
const MAX_TURN_RATE_RAD_S: f64 = 34.91;

/// The turn rate of an IMU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuReading {
    /// Time of the reading.
    pub stamp: Stamp,
    /// Turn rate about the axes of the sensor, rad/s.
    pub angular_velocity: Vector3,
    /// First element of the turn rate's covariance, rad²/s²; -1 says that the sensor measures no turn rate \[REP 145\].
    pub covariance: f64,
}

impl ImuReading {
    /// The turn rate around the base's vertical axis. `base_from_imu` is the rotation of the sensor on the base.
    ///
    /// # Errors
    /// When the sensor measures no turn rate, or a rate is not finite or beyond the range of gyros.
    pub fn gyro_rate(&self, base_from_imu: &UnitQuaternion<f64>) -> Result<GyroRate, Invalid> {
        if self.covariance == NOT_MEASURED {
            let expected = "0 or above: a measured turn rate";
            return Err(Invalid::new("angular_velocity_covariance[0]", NOT_MEASURED, "", expected));
        }
        for (name, value) in ["angular_velocity.x", "angular_velocity.y", "angular_velocity.z"]
            .iter()
            .zip(&self.angular_velocity)
        {
            require_finite(name, *value, "rad/s")?;
            require_in(name, *value, "rad/s", -MAX_TURN_RATE_RAD_S, MAX_TURN_RATE_RAD_S)?;
        }
        Ok(GyroRate { stamp: self.stamp, omega: (base_from_imu * self.angular_velocity).z })
    }
}

/// A reading and the frame of its axes, from the bytes of a message.
pub(in crate::ros) fn read_imu(bytes: &[u8], wire: Wire) -> Result<(String, ImuReading), CdrError> {
    let mut r = CdrReader::new(types::IMU, bytes, wire)?;
    let (stamp, frame) = header(&mut r)?;
    r.f64s::<4>("orientation")?;
    r.f64s::<9>("orientation_covariance")?;
    let rate: [f64; 3] = r.f64s("angular_velocity")?;
    let [covariance, ..] = r.f64s::<9>("angular_velocity_covariance")?;
    Ok((frame, ImuReading { stamp, angular_velocity: Vector3::from(rate), covariance }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ros_message;

    #[test]
    fn the_turn_rate_is_that_about_the_bases_vertical() {
        let message = ros_message::gyro("gyro", &GyroRate { stamp: Stamp::from_nanos(7), omega: 0.5 });
        let (frame, mut reading) = read_imu(message.bytes(), Wire::Cdr).unwrap();
        assert_eq!((frame.as_str(), reading.stamp), ("gyro", Stamp::from_nanos(7)));
        let level = UnitQuaternion::identity();
        assert_eq!(reading.gyro_rate(&level).unwrap().omega, 0.5);
        let upside_down = UnitQuaternion::from_euler_angles(std::f64::consts::PI, 0.0, 0.0);
        assert!((reading.gyro_rate(&upside_down).unwrap().omega + 0.5).abs() < 1e-12);
        reading.angular_velocity.y = f64::NAN;
        let problem = reading.gyro_rate(&level).unwrap_err().to_string();
        assert!(problem.starts_with("angular_velocity.y is NaN rad/s"), "{problem}");
        reading.angular_velocity.y = 1e30;
        assert!(reading.gyro_rate(&level).unwrap_err().to_string().contains("rad/s, expected"));
        reading.covariance = -1.0;
        assert!(reading.gyro_rate(&level).unwrap_err().to_string().contains("a measured turn rate"));
    }
}

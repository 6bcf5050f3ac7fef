//! `sensor_msgs/Imu`: the turn rate around the vertical.

use super::{pose, stamp};
use crate::generated::geometry_msgs::Vector3Message;
use crate::generated::sensor_msgs::Imu;
use nalgebra::UnitQuaternion;
use trundle_core::{GyroRate, Invalid, Stamp, Vector3};
use trundle_io::ImuReading;

/// The covariance element for a quantity that is not measured. Source: REP 145, `sensor_msgs/Imu`.
const NOT_MEASURED: f64 = -1.0;

/// The turn rate around the base's vertical axis, at `stamp` of the run. `base_from_imu` is the rotation of the sensor on the base.
///
/// # Errors
/// As [`ImuReading::gyro_rate`].
pub fn from_ros(imu: &Imu, stamp: Stamp, base_from_imu: &UnitQuaternion<f64>) -> Result<GyroRate, Invalid> {
    let rate = &imu.angular_velocity;
    let angular_velocity = Vector3::new(rate.x, rate.y, rate.z);
    let covariance = imu.angular_velocity_covariance[0];
    ImuReading { stamp, angular_velocity, covariance }.gyro_rate(base_from_imu)
}

/// A turn rate as a message: heading by `theta`, no acceleration, stamped `at` on the ROS clock.
#[must_use]
pub fn to_ros(omega: f64, theta: Option<f64>, at: Stamp, frame: &str) -> Imu {
    let mut imu = Imu {
        header: stamp::header(at, frame),
        orientation: pose::quaternion(&UnitQuaternion::from_euler_angles(0.0, 0.0, theta.unwrap_or(0.0))),
        angular_velocity: Vector3Message { x: 0.0, y: 0.0, z: omega },
        ..Imu::default()
    };
    imu.linear_acceleration_covariance[0] = NOT_MEASURED;
    if theta.is_none() {
        imu.orientation_covariance[0] = NOT_MEASURED;
    }
    imu
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_turn_rate_is_that_about_the_bases_vertical() {
        let mut imu = to_ros(0.5, None, Stamp::default(), "gyro");
        let level = UnitQuaternion::identity();
        assert_eq!(from_ros(&imu, Stamp::default(), &level).unwrap().omega, 0.5);
        let upside_down = UnitQuaternion::from_euler_angles(std::f64::consts::PI, 0.0, 0.0);
        assert!((from_ros(&imu, Stamp::default(), &upside_down).unwrap().omega + 0.5).abs() < 1e-12);
        imu.angular_velocity.z = f64::NAN;
        assert!(from_ros(&imu, Stamp::default(), &level).is_err());
        imu.angular_velocity_covariance[0] = -1.0;
        assert!(from_ros(&imu, Stamp::default(), &level).unwrap_err().to_string().contains("measured"));
    }
}

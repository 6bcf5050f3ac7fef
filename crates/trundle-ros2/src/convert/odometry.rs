//! `nav_msgs/Odometry`.

use super::{pose, stamp};
use crate::generated::nav_msgs::OdometryMessage;
use trundle_core::{Invalid, Odometry, Stamp, Twist2, require_finite};

/// The odometry of a message, at `stamp` of the run.
///
/// # Errors
/// When pose, twist or covariance is not finite, or the rotation was never set.
pub fn from_ros(message: &OdometryMessage, stamp: Stamp) -> Result<Odometry, Invalid> {
    let pose = pose::pose2(&message.pose.pose)?;
    let twist = &message.twist.twist;
    let v = require_finite("twist.linear.x", twist.linear.x, "m/s")?;
    let omega = require_finite("twist.angular.z", twist.angular.z, "rad/s")?;
    let covariance = pose::covariance(&message.pose.covariance, pose.theta)?;
    Odometry { stamp, pose, twist: Twist2::new(v, omega), covariance }.checked()
}

/// Names of the frames of odometry.
#[derive(Debug, Clone, Copy)]
pub struct OdometryFrames<'f> {
    /// The odometry's frame, as `odom`.
    pub odom: &'f str,
    /// The base's frame, as `base_link`.
    pub base: &'f str,
}

/// The odometry as a message, stamped `at` on the ROS clock.
#[must_use]
pub fn to_ros(odometry: &Odometry, at: Stamp, frames: OdometryFrames<'_>) -> OdometryMessage {
    let mut message = OdometryMessage {
        header: stamp::header(at, frames.odom),
        child_frame_id: frames.base.to_owned(),
        pose: pose::with_covariance(&odometry.pose, &odometry.covariance),
        ..OdometryMessage::default()
    };
    message.twist.twist = super::twist::to_ros(odometry.twist);
    message
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;
    use trundle_core::Pose2;

    #[test]
    fn odometry_goes_there_and_back() {
        let own = Odometry {
            stamp: Stamp::from_nanos(5),
            pose: Pose2::new(1.0, 2.0, -3.0),
            twist: Twist2::new(0.2, 0.1),
            covariance: Matrix3::from_diagonal_element(0.01),
        };
        let mut message =
            to_ros(&own, Stamp::from_nanos(7), OdometryFrames { odom: "odom", base: "base_link" });
        let back = from_ros(&message, own.stamp).unwrap();
        assert!(back.pose.distance(&own.pose) < 1e-12 && (back.covariance - own.covariance).norm() < 1e-12);
        assert_eq!((back.twist, back.stamp), (own.twist, own.stamp));
        message.pose.pose.position.y = f64::INFINITY;
        assert!(from_ros(&message, own.stamp).unwrap_err().to_string().starts_with("position.y is inf m"));
    }
}

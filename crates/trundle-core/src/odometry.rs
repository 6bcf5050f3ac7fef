//! The readings of wheel encoders and gyro, and the odometry computed from both.

use crate::{Invalid, Pose2, Stamp, Twist2, require_finite};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// The wheel encoders' counters, which wrap at 2^16 as the Kobuki's do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct WheelTicks {
    /// Stamp of the reading.
    pub stamp: Stamp,
    /// Left wheel, ticks, wrapping.
    pub left: u16,
    /// Right wheel, ticks, wrapping.
    pub right: u16,
}

/// A reading of the gyro's vertical axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GyroRate {
    /// Stamp of the reading.
    pub stamp: Stamp,
    /// Turn rate, counter-clockwise, rad/s, with the sensor's bias.
    pub omega: f64,
}

/// Pose of the robot by wheels and gyro.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Odometry {
    /// Stamp of the newest wheel reading included.
    pub stamp: Stamp,
    /// `odom_from_base`.
    pub pose: Pose2,
    /// The base's twist.
    pub twist: Twist2,
    /// Covariance of `pose` as a right perturbation (x m, y m, theta rad), accumulated since the start.
    pub covariance: Matrix3<f64>,
}

impl Odometry {
    /// The odometry, checked: each number finite, the variances not negative.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self, Invalid> {
        let Self { pose, twist, covariance, .. } = &self;
        for (name, value, unit) in [
            ("odometry x", pose.x, "m"),
            ("odometry y", pose.y, "m"),
            ("odometry theta", pose.theta, "rad"),
            ("odometry v", twist.v, "m/s"),
            ("odometry omega", twist.omega, "rad/s"),
        ] {
            require_finite(name, value, unit)?;
        }
        for (row, name) in ["x", "y", "theta"].into_iter().enumerate() {
            for value in covariance.row(row).iter() {
                require_finite("odometry covariance", *value, "")?;
            }
            if covariance[(row, row)] < 0.0 {
                let name = format!("odometry variance of {name}");
                return Err(Invalid::new(name, covariance[(row, row)], "", "0 or above"));
            }
        }
        Ok(self)
    }
}

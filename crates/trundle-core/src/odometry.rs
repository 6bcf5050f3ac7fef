//! The readings of wheel encoders and gyro, and the odometry computed from both.

use crate::{Pose2, Stamp, Twist2};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// The wheel encoders' counters, which wrap at 2^16 as the Kobuki's do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct WheelTicks {
    /// When they were read.
    pub stamp: Stamp,
    /// Left wheel, ticks, wrapping.
    pub left: u16,
    /// Right wheel, ticks, wrapping.
    pub right: u16,
}

/// One reading of the gyro's vertical axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GyroRate {
    /// When it was read.
    pub stamp: Stamp,
    /// Turn rate, counter-clockwise, rad/s, with the sensor's bias.
    pub omega: f64,
}

/// Pose of the robot by wheels and gyro.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Odometry {
    /// Of the newest wheel reading in it.
    pub stamp: Stamp,
    /// `odom_from_base`.
    pub pose: Pose2,
    /// The base's twist.
    pub twist: Twist2,
    /// Covariance of `pose` as a right perturbation (x m, y m, theta rad), grown since the start.
    pub covariance: Matrix3<f64>,
}

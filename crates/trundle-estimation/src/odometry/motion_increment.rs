//! Measured motion between two readings of the wheels.

use nalgebra::Matrix3;
use trundle_core::Stamp;

/// Motion between two readings of the wheels, without calibration: the input of an estimator of radii, wheelbase, bias and scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionIncrement {
    /// Stamp of the later reading.
    pub stamp: Stamp,
    /// Time between the readings, s, above 0.
    pub dt: f64,
    /// Distance of the left wheel for its nominal radius, m.
    pub left: f64,
    /// Distance of the right wheel for its nominal radius, m.
    pub right: f64,
    /// Turn by the gyro, including its bias and scale, rad; `None` without a gyro that covers the time and agrees with the wheels.
    pub turn_by_gyro: Option<f64>,
    /// Difference of the distances by wheels and gyro during a slip, m, 0 or more.
    pub slip: f64,
    /// Whether the robot is at rest: no recent tick, or none since the start, and no rate above the noise of the gyro.
    pub is_at_rest: bool,
    /// Covariance of motion that no sensor measured (a gap, a command without a tick), as a right perturbation (x m, y m, theta rad).
    pub unobserved: Matrix3<f64>,
}

impl MotionIncrement {
    /// An unknown motion of `dt` s with this covariance (x m, y m, theta rad).
    pub fn unknown(stamp: Stamp, dt: f64, unobserved: Matrix3<f64>) -> Self {
        Self {
            stamp,
            dt,
            left: 0.0,
            right: 0.0,
            turn_by_gyro: None,
            slip: 0.0,
            is_at_rest: false,
            unobserved,
        }
    }
}

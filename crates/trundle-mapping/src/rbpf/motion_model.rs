//! Covariance of an odometry step.

use crate::particle_config::MotionConfig;
use nalgebra::Matrix3;
use trundle_core::Pose2;

/// The covariance of an odometry's motion in its own frame (x, y in m, heading in rad).
///
/// The error of the distance acts along x. It also acts along y, since a turn during the step moves the end sideways by half of the turn.
pub(crate) fn motion_covariance(config: &MotionConfig, motion: Pose2) -> Matrix3<f64> {
    let (distance, turn) = (motion.position().norm(), motion.theta.abs());
    let shift = config.min_shift + config.shift_per_metre * distance + config.shift_per_radian * turn;
    let heading = config.min_turn + config.turn_per_metre * distance + config.turn_per_radian * turn;
    let aside = 0.5 * shift + 0.5 * distance * heading;
    Matrix3::from_diagonal(&nalgebra::Vector3::new(shift * shift, aside * aside, heading * heading))
}

/// Covariance of a step without odometry, as after a jump: m, rad.
pub(crate) fn unknown_motion_covariance() -> Matrix3<f64> {
    Matrix3::from_diagonal(&nalgebra::Vector3::new(0.16, 0.16, 0.04))
}

/// Standard deviation along x and y of a step without odometry motion but with different scans \[m\]. Source: ours, twice the step of 0.5
/// m/s at 5 Hz.
const SILENT_SHIFT_M: f64 = 0.2;
/// Standard deviation of such a step's turn \[rad\]. Source: ours, 1 rad/s at 5 Hz.
const SILENT_TURN_RAD: f64 = 0.2;

/// Covariance of a step without odometry motion but with different scans: m, rad.
pub(crate) fn silent_motion_covariance() -> Matrix3<f64> {
    let (shift, turn) = (SILENT_SHIFT_M * SILENT_SHIFT_M, SILENT_TURN_RAD * SILENT_TURN_RAD);
    Matrix3::from_diagonal(&nalgebra::Vector3::new(shift, shift, turn))
}

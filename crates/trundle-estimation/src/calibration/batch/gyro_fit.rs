//! Scale and bias of the gyro against the camera.

use super::error::CalibrationError;
use super::estimate::Estimate;
use super::gyro_angle::GyroAngle;
use super::linear_fit::LinearFit;
use super::turn_axis::turns;
use nalgebra::Vector2;
use trundle_core::{Pose3, Stamp, Vector3};

/// Scale and bias of the gyro.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GyroFit {
    /// True over measured turn rate.
    pub scale: Estimate,
    /// Rate that the gyro measures at rest, rad/s.
    pub bias: Estimate,
}

/// Length of a segment: 2 s. Source: ours.
const SEGMENT_S: f64 = 2.0;
/// Smallest number of segments. Source: ours.
const MIN_SEGMENTS: usize = 5;
/// Smallest noise of a segment's turn: 0.5 mrad. Source: ours.
const MIN_TURN_SIGMA_RAD: f64 = 5e-4;

/// Fits scale and bias of the gyro to the camera's turns around `axis` (camera frame), in segments of 2 s.
///
/// # Errors
/// When camera and gyro cover less than 10 s together.
pub fn fit_gyro(
    poses: &[(Stamp, Pose3)],
    axis: Vector3,
    gyro: &GyroAngle,
) -> Result<GyroFit, CalibrationError> {
    let mut fit = LinearFit::new(MIN_TURN_SIGMA_RAD);
    let (mut count, mut by_camera, mut from) = (0, 0.0, None);
    for turn in turns(poses, axis) {
        let start = *from.get_or_insert(turn.from);
        by_camera += turn.angle;
        if turn.to - start >= SEGMENT_S {
            if let Some(by_gyro) = gyro.turn(start, turn.to) {
                fit.add(Vector2::new(by_gyro, start - turn.to), by_camera);
                count += 1;
            }
            (by_camera, from) = (0.0, None);
        }
    }
    let solution = fit.solve().filter(|_| count >= MIN_SEGMENTS);
    let solution = solution.ok_or(CalibrationError::TooFewReadings {
        sensor: "segments of 2 s with camera and gyro",
        found: count,
        expected: MIN_SEGMENTS,
        advice: "record 10 s or more with turns",
    })?;
    let scale = solution.x[0];
    let sigma = |i: usize| solution.covariance[(i, i)].sqrt();
    Ok(GyroFit {
        scale: Estimate::new(scale, sigma(0)),
        bias: Estimate::new(solution.x[1] / scale, sigma(1) / scale),
    })
}

//! `image_delay_s` by the camera's turns against the gyro.

use super::camera_track::track_camera;
use super::recording::CalibrationInput;
use super::values::{CalibratedValue, Calibration};
use crate::{AppError, StepProgress};
use trundle_estimation::{estimate_image_delay, turn_axis};

/// Delay of the image stamps against the gyro, s, with scale and bias of the gyro.
///
/// # Errors
/// When images or gyro are missing, the robot turns too little, or camera and gyro contradict each other.
pub fn calibrate_delay(
    input: &CalibrationInput,
    progress: &dyn StepProgress,
) -> Result<Calibration, AppError> {
    let track = track_camera(input, progress, |_| ())?.of_most_images(input)?;
    let axis = turn_axis(&track.poses, input.expected_up()).map_err(|error| input.refused(&error))?;
    let found =
        estimate_image_delay(&track.poses, axis, &input.gyro()).map_err(|error| input.refused(&error))?;
    // The stamps of the images are corrected by the delay in use.
    let in_use = input.images.robot.image_delay;
    let delay = (in_use + found.delay.value, found.delay.sigma);
    let scale = (found.gyro_scale.value, found.gyro_scale.sigma);
    let bias = (found.gyro_bias.value, found.gyro_bias.sigma);
    Ok(Calibration {
        values: vec![
            CalibratedValue::key("image_delay_s", delay, "s", in_use, 4),
            CalibratedValue::info("gyro, true over measured rate", scale, "", 4),
            CalibratedValue::info("gyro, rate at rest", bias, "rad/s", 5),
        ],
        notes: vec![format!(
            "correlation of camera and gyro {:.3} over {} pairs of images, residual {:.2} mrad",
            found.correlation,
            found.pairs,
            found.residual * 1e3
        )],
    })
}

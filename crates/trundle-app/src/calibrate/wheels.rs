//! `[drive]` by the camera's trajectory.

use super::camera_track::track_camera;
use super::recording::CalibrationInput;
use super::values::{CalibratedValue, Calibration};
use crate::{AppError, StepProgress};
use trundle_core::{Pose3, Stamp, Vector3};
use trundle_estimation::{
    CalibrationError, Estimate, WheelCameraFit, fit_gyro, fit_wheels_and_camera, turn_axis,
};

/// Largest standard deviation of a radius or a wheelbase that is shown, ratio: 0.01. Source: ours.
const MAX_SIGMA_RATIO: f64 = 0.01;

/// Radii of the wheels and distance between the wheels, with the scale of the gyro.
///
/// # Errors
/// When images or wheels are missing, or the drive is too short, without a turn or without a straight part.
pub fn calibrate_wheels(
    input: &CalibrationInput,
    progress: &dyn StepProgress,
) -> Result<Calibration, AppError> {
    let track = track_camera(input, progress, |_| ())?.of_most_images(input)?;
    let refused = |error: CalibrationError| input.refused(&error);
    let drive = &input.images.robot.drive;
    let axis = turn_axis(&track.poses, input.expected_up()).map_err(refused)?;
    let fit = fit_wheels_and_camera(&track.poses, axis, &input.wheels(), drive).map_err(refused)?;
    require_shown("the wheels' radius", &fit.mean_radius).map_err(refused)?;
    require_shown("the wheelbase", &fit.wheelbase).map_err(refused)?;
    let mut calibration = of_fit(&fit, input);
    add_gyro(&mut calibration, input, &track.poses, axis);
    Ok(calibration)
}

fn require_shown(what: &'static str, found: &Estimate) -> Result<(), CalibrationError> {
    let ratio = found.sigma / found.value;
    if ratio <= MAX_SIGMA_RATIO {
        return Ok(());
    }
    Err(CalibrationError::NotObservable {
        what,
        quantity: "its standard deviation",
        found: ratio * 100.0,
        unit: "%",
        expected: format!("{} % or less", MAX_SIGMA_RATIO * 100.0),
        advice: "drive 5 m or more straight and turn on the spot by two full turns both ways",
    })
}

fn of_fit(fit: &WheelCameraFit, input: &CalibrationInput) -> Calibration {
    let drive = &input.images.robot.drive;
    let pair = |estimate: Estimate| (estimate.value, estimate.sigma);
    let (radius, base) = (pair(fit.mean_radius), pair(fit.wheelbase));
    Calibration {
        values: vec![
            CalibratedValue::key("drive.wheel_radius_m", radius, "m", drive.wheel_radius, 5),
            CalibratedValue::key("drive.wheelbase_m", base, "m", drive.wheelbase, 5),
            CalibratedValue::info("radius of the left wheel", pair(fit.left_radius), "m", 5),
            CalibratedValue::info("radius of the right wheel", pair(fit.right_radius), "m", 5),
        ],
        notes: vec![format!(
            "{} segments of the drive, residual {:.1} mm and {:.2} mrad",
            fit.segments,
            fit.displacement_residual * 1e3,
            fit.turn_residual * 1e3
        )],
    }
}

/// Adds the gyro's scale, or the reason why the scale is unknown.
fn add_gyro(
    calibration: &mut Calibration,
    input: &CalibrationInput,
    poses: &[(Stamp, Pose3)],
    axis: Vector3,
) {
    match fit_gyro(poses, axis, &input.gyro()) {
        Ok(gyro) => calibration.values.push(CalibratedValue::info(
            "gyro, true over measured rate",
            (gyro.scale.value, gyro.scale.sigma),
            "",
            4,
        )),
        Err(error) => calibration.notes.push(format!("not found: the gyro's scale: {error}")),
    }
}

//! `[mount]` by the floor in the depth images and by the camera's trajectory against the wheels.

use super::camera_track::track_camera;
use super::recording::CalibrationInput;
use super::values::{CalibratedValue, Calibration};
use crate::{AppError, StepProgress};
use trundle_core::{RgbdImage, Vector3};
use trundle_estimation::{
    CalibrationError, Estimate, FloorMount, FloorSearch, FloorView, WheelCameraFit, fit_wheels_and_camera,
    turn_axis,
};
use trundle_runtime::CameraMount;

/// Largest number of images whose floor is fitted. Source: ours; more do not change the mean by 0.1 mm.
const MAX_FLOOR_IMAGES: usize = 200;
/// Smallest number of images with floor. Source: ours.
const MIN_FLOOR_IMAGES: usize = 5;
/// Largest standard deviation of an offset that is shown: 0.01 m. Source: ours.
const MAX_OFFSET_SIGMA_M: f64 = 0.01;
/// Largest standard deviation of a yaw that is shown: 1 deg. Source: ours.
const MAX_YAW_SIGMA_DEG: f64 = 1.0;
/// Angle of the turning axis to the floor's normal above which a note warns: 0.5 deg. Source: ours.
const MAX_AXIS_ANGLE_DEG: f64 = 0.5;

/// Pose of the camera on the base.
///
/// # Errors
/// When images are missing or show no floor.
pub fn calibrate_mount(
    input: &CalibrationInput,
    progress: &dyn StepProgress,
) -> Result<Calibration, AppError> {
    let mut floor = FloorImages::new(input);
    let track = track_camera(input, progress, |image| floor.add(image))?;
    let views = floor.views()?;
    let track = track.of_most_images(input)?;
    let up = views.iter().map(|view| view.up).sum::<Vector3>().normalize();
    let mut calibration = Calibration::default();
    let axis = turn_axis(&track.poses, up);
    add_floor(&mut calibration, input, &views, axis.as_ref().ok());
    calibration.notes.extend(axis.as_ref().ok().and_then(|axis| axis_warning(axis.angle(&up))));
    let drive = &input.images.robot.drive;
    let fit = axis.and_then(|_| fit_wheels_and_camera(&track.poses, up, &input.wheels(), drive));
    match fit {
        Ok(fit) => add_offsets(&mut calibration, input, &fit),
        Err(error) => calibration.notes.push(not_shown("mount.x_m, mount.y_m, mount.yaw_deg", &error)),
    }
    Ok(calibration)
}

/// The floor in some of the images.
struct FloorImages<'a> {
    input: &'a CalibrationInput,
    search: FloorSearch,
    /// Step between two used images \[images\].
    step: usize,
    seen: usize,
}

impl<'a> FloorImages<'a> {
    fn new(input: &'a CalibrationInput) -> Self {
        let step = input.images.len().div_ceil(MAX_FLOOR_IMAGES).max(1);
        Self { input, search: FloorSearch::new(input.expected_up()), step, seen: 0 }
    }

    fn add(&mut self, image: &RgbdImage) {
        if self.seen.is_multiple_of(self.step) {
            self.search.add(image.depth(), &self.input.images.camera.model.camera);
        }
        self.seen += 1;
    }

    /// The floor in each image that shows the floor.
    fn views(&self) -> Result<Vec<FloorView>, AppError> {
        let views = self.search.views();
        if views.len() >= MIN_FLOOR_IMAGES {
            return Ok(views);
        }
        let (tried, with_depth) = self.search.image_counts();
        let cause = if with_depth == 0 { "no image has depth" } else { "the camera sees too little of it" };
        let found = views.len();
        Err(self.input.refused(&format!(
            "floor in {found} of {tried} images, expected {MIN_FLOOR_IMAGES} or more: {cause}; check the depth camera, \
             clear 2 m of floor before the robot, and set mount.pitch_deg to within 15 deg"
        )))
    }
}

fn add_floor(
    calibration: &mut Calibration,
    input: &CalibrationInput,
    views: &[FloorView],
    axis: Option<&Vector3>,
) {
    let Some(floor) = FloorMount::of(views, axis) else { return };
    calibration.values.extend(floor_values(&floor, &input.images.robot.mount));
    calibration.notes.push(format!("floor seen in {} images", floor.images));
}

/// The keys of the robot file that the floor determines, next to the mount in use.
#[must_use]
pub fn floor_values(floor: &FloorMount, before: &CameraMount) -> [CalibratedValue; 3] {
    let height = (floor.height.value, floor.height.sigma);
    [
        CalibratedValue::key("mount.z_m", height, "m", before.z, 4),
        CalibratedValue::key("mount.pitch_deg", degrees(floor.pitch), "deg", before.pitch_deg, 3),
        CalibratedValue::key("mount.roll_deg", degrees(floor.roll), "deg", before.roll_deg, 3),
    ]
}

fn add_offsets(calibration: &mut Calibration, input: &CalibrationInput, fit: &WheelCameraFit) {
    let before = &input.images.robot.mount;
    let is_shown = |offset: &Estimate| offset.sigma <= MAX_OFFSET_SIGMA_M;
    let offsets = [("mount.x_m", fit.offset_x, before.x), ("mount.y_m", fit.offset_y, before.y)];
    for (name, offset, before) in offsets {
        if is_shown(&offset) {
            calibration.values.push(CalibratedValue::key(name, (offset.value, offset.sigma), "m", before, 4));
        } else {
            let error = not_observable("the camera's offset", offset.sigma, "m", MAX_OFFSET_SIGMA_M);
            calibration.notes.push(not_shown(name, &error));
        }
    }
    let yaw = degrees(fit.yaw);
    if yaw.1 <= MAX_YAW_SIGMA_DEG {
        calibration.values.push(CalibratedValue::key("mount.yaw_deg", yaw, "deg", before.yaw_deg, 3));
    } else {
        let error = not_observable("the camera's yaw", yaw.1, "deg", MAX_YAW_SIGMA_DEG);
        calibration.notes.push(not_shown("mount.yaw_deg", &error));
    }
    calibration.notes.push(format!(
        "{} segments of the drive, residual {:.1} mm and {:.2} mrad",
        fit.segments,
        fit.displacement_residual * 1e3,
        fit.turn_residual * 1e3
    ));
}

fn degrees(angle: Estimate) -> (f64, f64) {
    (angle.value.to_degrees(), angle.sigma.to_degrees())
}

fn not_observable(what: &'static str, found: f64, unit: &'static str, max: f64) -> CalibrationError {
    CalibrationError::NotObservable {
        what,
        quantity: "its standard deviation",
        found,
        unit,
        expected: format!("{max} {unit} or less"),
        advice: "turn on the spot by a full turn both ways and drive 1 m straight",
    }
}

fn not_shown(keys: &str, error: &CalibrationError) -> String {
    format!("not found: {keys}: {error}")
}

/// A warning if the robot turns around another axis than the floor's normal.
fn axis_warning(angle: f64) -> Option<String> {
    let degrees = angle.to_degrees();
    (degrees > MAX_AXIS_ANGLE_DEG).then(|| {
        format!(
            "the robot turns around an axis {degrees:.2} deg off the floor's normal, expected {MAX_AXIS_ANGLE_DEG} deg \
             or less: is the floor flat, the camera fixed, and the camera calibrated?"
        )
    })
}

//! The camera's trajectory over a recording, by the images alone.

use super::recording::CalibrationInput;
use crate::{AppError, StepProgress, stop};
use trundle_core::{Pose3, RgbdImage, Stamp};
use trundle_slam::RgbdSlam;

/// The camera's trajectory over a recording.
pub(super) struct CameraTrack {
    /// `visual_from_camera`, by rising stamp.
    pub(super) poses: Vec<(Stamp, Pose3)>,
    /// Number of images that are located.
    located: usize,
}

/// Fraction of the images that must be located: 0.5. Source: ours.
const MIN_LOCATED_RATIO: f64 = 0.5;

/// Tracks all images. Wheels and mount give no prior: they may be wrong. `on_image` receives each image.
///
/// # Errors
/// When the images cannot be read, or the user stops.
pub(super) fn track_camera(
    input: &CalibrationInput,
    progress: &dyn StepProgress,
    mut on_image: impl FnMut(&RgbdImage),
) -> Result<CameraTrack, AppError> {
    let images = &input.images;
    let mut config = images.robot.slam.clone();
    config.kept_frames = usize::MAX;
    let mut slam =
        RgbdSlam::new(images.camera.model.camera, config)?.starting_at(images.robot.mount.base_from_camera());
    progress.begin(Some(images.len()));
    let mut located = 0;
    for (i, frame) in images.frames()?.enumerate() {
        if stop::is_requested(|| format!("{i} of {} images", images.len())) {
            progress.end();
            return Err(AppError::Stopped);
        }
        match frame?.decode() {
            Ok(image) => {
                on_image(&image);
                located += usize::from(slam.step(&image, None).tracking.is_located());
            }
            Err(error) => progress.pause(&|| tracing::warn!("image skipped: {error}")),
        }
        progress.advance();
    }
    progress.end();
    slam.finish_refining();
    Ok(CameraTrack { poses: slam.trajectory(), located })
}

impl CameraTrack {
    /// This trajectory, if it is of most images of `input`.
    ///
    /// # Errors
    /// When most images are not located.
    pub(super) fn of_most_images(self, input: &CalibrationInput) -> Result<Self, AppError> {
        let (located, images) = (self.located, input.images.len());
        if located as f64 >= MIN_LOCATED_RATIO * images as f64 {
            return Ok(self);
        }
        Err(input.refused(&format!(
            "only {located} of {images} images are located, expected half or more; record in a room with texture and \
             light, and turn more slowly"
        )))
    }
}

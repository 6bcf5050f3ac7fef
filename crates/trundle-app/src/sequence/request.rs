//! What a sequence is tracked with: camera, first pose, map, seed.

use crate::vocabulary_file::vocabulary_or_builtin;
use crate::{AppError, log_warnings};
use std::path::PathBuf;
use trundle_io::{CameraModel, Expected, MapImage, SequenceCamera, TumSequence};
use trundle_runtime::level_from_first_camera;
use trundle_slam::{Mode, RgbdSlam, SlamConfig};

/// A recorded sequence and how to track it.
#[derive(Debug, Clone)]
pub struct SequenceRequest {
    /// A TUM RGB-D folder.
    pub dir: PathBuf,
    /// A camera preset or a file of one; `None` for the folder's own.
    pub camera: Option<String>,
    /// Depth units a metre; `None` for the camera's own.
    pub depth_scale: Option<f64>,
    /// Frames to track; `None` for all.
    pub frames: Option<usize>,
    /// Height of the first camera above the floor, m.
    pub height: f64,
    /// Downward tilt of the first camera, deg.
    pub tilt_deg: f64,
    /// Roll of the first camera to its right, deg.
    pub roll_deg: f64,
    /// The visual map of an earlier run, in which the camera is localized first.
    pub map: Option<PathBuf>,
    /// Whether that map stays as it is.
    pub localize_only: bool,
    /// The vocabulary by which places are recognised; `None` for the built-in one.
    pub vocabulary: Option<PathBuf>,
    /// Seed of the random sampling.
    pub seed: u64,
    /// Format of the picture of the map that is written.
    pub map_image: MapImage,
}

impl SequenceRequest {
    /// The camera: the one asked for, else the folder's own, else one that is assumed. Its warnings are logged.
    ///
    /// # Errors
    /// When there is no such preset or file.
    pub fn camera(&self) -> Result<SequenceCamera, AppError> {
        let camera = SequenceCamera::choose(self.camera.as_deref(), &self.dir)?;
        log_warnings(&camera.warnings);
        Ok(camera)
    }

    /// The sequence, its images of the camera's size. Its warnings are logged.
    ///
    /// # Errors
    /// When the folder cannot be read as a TUM RGB-D folder.
    pub fn open(&self, model: &CameraModel) -> Result<TumSequence, AppError> {
        let scale = self.depth_scale.unwrap_or(model.depth_scale);
        let sequence = TumSequence::open(&self.dir, scale, TumSequence::MAX_DIFFERENCE)?;
        log_warnings(sequence.warnings());
        Ok(sequence.with_size(model.camera.width(), model.camera.height()))
    }

    /// A tracker with an empty map, or with the map asked for.
    pub(super) fn slam(&self, model: &CameraModel) -> Result<RgbdSlam, AppError> {
        // The error of a recording is taken over all of its frames.
        let config = SlamConfig { seed: self.seed, kept_frames: usize::MAX, ..SlamConfig::default() };
        let camera = model.camera;
        let vocabulary = vocabulary_or_builtin(self.vocabulary.as_deref())?;
        let Some(file) = &self.map else {
            let level_from_camera = level_from_first_camera(self.height, self.tilt_deg, self.roll_deg)?;
            let slam = RgbdSlam::new(camera, config)?.with_vocabulary(&vocabulary);
            return Ok(slam.starting_at(level_from_camera));
        };
        let refused =
            |problem: &dyn std::fmt::Display| AppError::Input(format!("{}: {problem}", file.display()));
        Expected::VisualMap.check(file)?;
        let bytes = std::fs::read(file).map_err(|error| refused(&error))?;
        let mut slam = RgbdSlam::load(&bytes, camera, config).map_err(|error| refused(&error))?;
        slam.set_vocabulary(&vocabulary);
        slam.set_mode(if self.localize_only { Mode::Localisation } else { Mode::Mapping });
        Ok(slam)
    }
}

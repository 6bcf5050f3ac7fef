//! Request to map a log: filter, laser, initial map.

use super::log_input::DepthLog;
use crate::{AppError, read_map};
use std::path::{Path, PathBuf};
use trundle_io::{Expected, FileKind, LaserLogOptions, MapImage, RosSequenceOptions};
use trundle_mapping::{MapLocalizer, MotionConfig, ParticleConfig, ParticleMapper, PosePriorConfig};

/// A log and how to map it.
#[derive(Debug, Clone)]
pub struct LaserMapRequest {
    /// A CARMEN log, a bag, a recording of trundle or a TUM RGB-D folder.
    pub log: PathBuf,
    /// Whether a recording of trundle may be cut: it is read up to the cut.
    pub recover: bool,
    /// The topics of a bag with RGB-D images.
    pub topics: RosSequenceOptions,
    /// The motion of an RGB-D folder: a TUM trajectory of the camera; `None` for the folder's own.
    pub poses: Option<PathBuf>,
    /// Whether these poses drift: only their steps are used, and loops are closed.
    pub poses_drift: bool,
    /// Particles of the filter.
    pub particles: usize,
    /// Seed of the filter.
    pub seed: u64,
    /// Side of a cell, m.
    pub resolution: f64,
    /// The laser, if the log does not contain it.
    pub laser: LaserLogOptions,
    /// The map of an earlier run, in which the robot is localized first.
    pub map: Option<PathBuf>,
    /// Whether each beam is corrected for the motion of the base during the scan, if the log has the times of the beams.
    pub deskew: bool,
    /// Format of the picture of the map that is written.
    pub map_image: MapImage,
}

impl LaserMapRequest {
    /// A new filter, or one that continues the saved map.
    pub(super) fn mapper(&self, depth: Option<&DepthLog>) -> Result<ParticleMapper, AppError> {
        let config = self.config(depth);
        let Some(file) = &self.map else { return Ok(ParticleMapper::new(config, self.seed)?) };
        let bytes = read_filter(file)?;
        let mut mapper = ParticleMapper::load(&bytes, config).map_err(|error| refused(file, &error))?;
        mapper.kidnapped();
        Ok(mapper)
    }

    /// A localizer in the map `file`: a saved filter, or a grid by its YAML.
    pub(super) fn localizer(&self, file: &Path, depth: Option<&DepthLog>) -> Result<MapLocalizer, AppError> {
        if FileKind::of(file)? == FileKind::MapYaml {
            let grid = read_map(file)?;
            let resolution = grid.geometry().resolution;
            let mut config = self.config(depth);
            config.map = config.map.with_resolution(resolution);
            return Ok(MapLocalizer::from_grid(&grid, config, self.seed)?);
        }
        Expected::LocalizationMap.check(file)?;
        let bytes = read_filter(file)?;
        MapLocalizer::load(&bytes, self.config(depth), self.seed).map_err(|error| refused(file, &error))
    }

    fn config(&self, depth: Option<&DepthLog>) -> ParticleConfig {
        let mut config = ParticleConfig::default();
        config.particles = self.particles;
        config.map = config.map.with_resolution(self.resolution);
        match depth {
            Some(depth) => self.depth_config(depth, config),
            None => config,
        }
    }

    /// The filter's settings for a depth camera: its range, noise and blind range, and the errors of its motion.
    fn depth_config(&self, depth: &DepthLog, config: ParticleConfig) -> ParticleConfig {
        let by_wheels = depth.by_wheels;
        let motion = if by_wheels { MotionConfig::default() } else { tracked_camera_motion() };
        let pose_prior = (!by_wheels && !self.poses_drift).then(PosePriorConfig::default);
        let mut config = depth_filter(depth, motion, config);
        config.pose_prior = pose_prior;
        config
    }
}

/// The settings of a filter for the scans of a depth camera, whose motion has these errors; the others are those of `config`.
pub(crate) fn depth_filter(
    depth: &DepthLog,
    motion: MotionConfig,
    mut config: ParticleConfig,
) -> ParticleConfig {
    let DepthLog { scan, blind_range, .. } = depth;
    config.map.max_range = scan.max_range;
    config.map.blind_range = *blind_range;
    config.motion = motion;
    config.range_noise = DEPTH_RANGE_NOISE_M;
    config.range_noise_growth = scan.noise_growth;
    config
}

/// Standard deviation of a range of the depth camera at short distance \[m\]. Source: ours.
const DEPTH_RANGE_NOISE_M: f64 = 0.01;

/// The motion of a tracked camera: a tenth of the noise of wheels alone. The wheels' noise cannot be that small: the
/// drift of their heading is the same on every metre, and a filter with such values distorts its map.
fn tracked_camera_motion() -> MotionConfig {
    let mut config = MotionConfig::default();
    config.shift_per_metre = 0.05;
    config.shift_per_radian = 0.02;
    config.turn_per_metre = 0.02;
    config.turn_per_radian = 0.04;
    config.min_shift = 0.005;
    config.min_turn = 0.003;
    config
}

/// The bytes of a saved filter.
fn read_filter(file: &Path) -> Result<Vec<u8>, AppError> {
    Expected::FilterMap.check(file)?;
    std::fs::read(file).map_err(|error| refused(file, &error))
}

fn refused(file: &Path, problem: &dyn std::fmt::Display) -> AppError {
    AppError::Input(format!("{}: {problem}", file.display()))
}

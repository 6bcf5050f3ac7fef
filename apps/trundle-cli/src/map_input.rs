//! What `trundle map` reads: a CARMEN log, a ROS 2 bag, or an RGB-D folder whose depth images become scans.

mod depth_folder;

use crate::failure::Failure;
use std::path::Path;
use trundle::io::{LaserLog, LaserLogOptions, read_laser_log};
use trundle::mapping::{MapperConfig, ParticleConfig};
use trundle::runtime::RobotConfig;

/// A log, and what kind of sensor took it.
pub struct MapInput {
    /// Scans with odometry.
    pub log: LaserLog,
    /// Of a depth camera: the range under its view, m.
    blind_range: Option<f64>,
}

impl MapInput {
    /// Reads `path`: a folder with `rgb.txt` is a TUM RGB-D folder, else a ROS 2 bag or a CARMEN log.
    pub fn read(path: &Path, options: &LaserLogOptions, quiet: bool) -> Result<Self, Failure> {
        if path.join("rgb.txt").exists() {
            let (log, blind_range) = depth_folder::read(path, quiet)?;
            return Ok(Self { log, blind_range: Some(blind_range) });
        }
        Ok(Self { log: read_laser_log(path, options)?, blind_range: None })
    }

    /// The filter's settings for this sensor: those of a laser, or the reach and the noise of a depth camera.
    pub fn tuned(&self, config: ParticleConfig) -> ParticleConfig {
        let Some(blind_range) = self.blind_range else { return config };
        let scan = RobotConfig::default().scan;
        ParticleConfig {
            map: MapperConfig { max_range: scan.max_range, blind_range, ..config.map },
            range_noise: scan.noise_base.max(0.01),
            range_noise_growth: scan.noise_growth,
            ..config
        }
    }
}

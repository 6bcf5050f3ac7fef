//! What `trundle map` reads: a CARMEN log, a ROS 2 bag, or an RGB-D folder whose depth images become scans.

mod depth_folder;

use crate::failure::Failure;
use std::path::Path;
use trundle::io::{LaserLog, LaserLogOptions, read_laser_log};
use trundle::mapping::{MapperConfig, ParticleConfig};
use trundle::runtime::RobotConfig;

/// Reads `path`: a folder with `rgb.txt` is a TUM RGB-D folder, else a ROS 2 bag or a CARMEN log.
pub fn read(path: &Path, options: &LaserLogOptions, quiet: bool) -> Result<LaserLog, Failure> {
    if is_depth_folder(path) { depth_folder::read(path, quiet) } else { Ok(read_laser_log(path, options)?) }
}

/// The filter's settings for the sensor of `path`: those of a laser, or the reach and the noise of a depth camera.
pub fn tuned(path: &Path, config: ParticleConfig) -> ParticleConfig {
    if !is_depth_folder(path) {
        return config;
    }
    let scan = RobotConfig::default().scan;
    ParticleConfig {
        map: MapperConfig { max_range: scan.max_range, ..config.map },
        range_noise: 0.01,
        range_noise_growth: scan.noise_growth,
        ..config
    }
}

fn is_depth_folder(path: &Path) -> bool {
    path.join("rgb.txt").exists()
}

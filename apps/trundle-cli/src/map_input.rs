//! What `trundle map` reads: a CARMEN log, a ROS 2 bag, or an RGB-D folder whose depth images become scans.

mod depth_folder;

use crate::map::MapArgs;
use std::path::Path;
use trundle::app::AppError;
use trundle::io::{LaserLog, LaserLogOptions, read_laser_log};
use trundle::mapping::{MapperConfig, MotionConfig, ParticleConfig, PosePriorConfig};
use trundle::runtime::RobotConfig;

/// Reads the log: a folder with `rgb.txt` is a TUM RGB-D folder, else a ROS 2 bag or a CARMEN log.
pub fn read(args: &MapArgs, options: &LaserLogOptions) -> Result<LaserLog, AppError> {
    if !is_depth_folder(&args.log) {
        if args.poses.is_some() {
            let log = args.log.display();
            return Err(AppError::Input(format!(
                "--poses is about the camera of an RGB-D folder, and {log} is none (it has no rgb.txt)"
            )));
        }
        return Ok(read_laser_log(&args.log, options)?);
    }
    if let Some(first) = args.given_laser_options().first() {
        let folder = args.log.display();
        return Err(AppError::Input(format!(
            "{first} is about a laser, but {folder} is an RGB-D folder: its camera.toml says what the camera is, and the camera \
             sits as on the default robot, or where groundtruth.txt says"
        )));
    }
    depth_folder::read(&args.log, args.poses.as_deref(), args.common.quiet)
}

/// The filter's settings for what is read: those of a laser, or the reach, the noise and the blind range of a depth camera, and
/// the errors of its motion.
pub fn tuned(args: &MapArgs, config: ParticleConfig) -> Result<ParticleConfig, AppError> {
    let path = &args.log;
    if !is_depth_folder(path) {
        return Ok(config);
    }
    let by_wheels = args.poses.is_none() && path.join("odometry.txt").exists();
    let scan = RobotConfig::default().scan;
    let blind_range = depth_folder::scanner(path)?.0.blind_range();
    Ok(ParticleConfig {
        map: MapperConfig { max_range: scan.max_range, blind_range, ..config.map },
        motion: if by_wheels { MotionConfig::default() } else { tracked_camera() },
        pose_prior: (!by_wheels && !args.poses_drift).then(PosePriorConfig::default),
        range_noise: 0.01,
        range_noise_growth: scan.noise_growth,
        ..config
    })
}

/// The motion of a tracked camera: ten times as good as that of wheels alone. (Of wheels this is not to be said: the drift of
/// their heading is the same on every metre, and a filter that trusts them bends its map with them.)
fn tracked_camera() -> MotionConfig {
    MotionConfig {
        shift_per_metre: 0.05,
        shift_per_radian: 0.02,
        turn_per_metre: 0.02,
        turn_per_radian: 0.04,
        least_shift: 0.005,
        least_turn: 0.003,
    }
}

fn is_depth_folder(path: &Path) -> bool {
    path.join("rgb.txt").exists()
}

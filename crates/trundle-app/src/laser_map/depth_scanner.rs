//! The scanner of a folder's depth camera, mounted as on the default robot.

use crate::AppError;
use std::path::Path;
use trundle_io::CameraModel;
use trundle_mapping::DepthScanner;
use trundle_runtime::RobotConfig;

/// The scanner of the folder's camera, mounted as on the default robot.
pub fn depth_scanner(dir: &Path) -> Result<(DepthScanner, CameraModel), AppError> {
    let own = dir.join("camera.toml");
    let model = if own.exists() { CameraModel::read(&own)? } else { CameraModel::named("freiburg1")? };
    let robot = RobotConfig::default();
    Ok((DepthScanner::new(model.camera, robot.mount.base_from_camera(), robot.scan)?, model))
}

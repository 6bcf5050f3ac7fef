//! The scanner of a folder's depth camera, mounted as on the default robot.

use crate::AppError;
use std::path::Path;
use trundle_io::SequenceCamera;
use trundle_mapping::DepthScanner;
use trundle_runtime::RobotConfig;

/// The scanner of the folder's camera, mounted as on the default robot.
pub fn depth_scanner(dir: &Path) -> Result<(DepthScanner, SequenceCamera), AppError> {
    let camera = SequenceCamera::choose(None, dir)?;
    let model = camera.model;
    let robot = RobotConfig::default();
    Ok((DepthScanner::new(model.camera, robot.mount.base_from_camera(), robot.scan)?, camera))
}

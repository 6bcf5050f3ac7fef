//! The scans of a CARMEN log, a ROS 2 bag, or an RGB-D folder whose depth images become scans.

use super::depth_folder;
use super::request::LaserMapRequest;
use crate::{AppError, StepProgress};
use std::path::Path;
use trundle_io::{FileKind, LaserLog, read_laser_log};

/// Reads the log: a folder with lists of images is a TUM RGB-D folder, else a ROS 2 bag or a CARMEN log.
///
/// # Errors
/// Names the file, and the line or frame that cannot be accepted.
pub fn read_log(request: &LaserMapRequest, progress: &dyn StepProgress) -> Result<LaserLog, AppError> {
    if is_depth_folder(&request.log) {
        depth_folder::read(&request.log, request.poses.as_deref(), progress)
    } else {
        Ok(read_laser_log(&request.log, &request.laser)?)
    }
}

/// Whether this is a TUM RGB-D folder.
#[must_use]
pub fn is_depth_folder(path: &Path) -> bool {
    matches!(FileKind::of(path), Ok(FileKind::SequenceFolder))
}

//! Reading of inputs whose warnings are logged.

use crate::AppError;
use std::path::Path;
use trundle_core::{OccupancyGrid, Pose3, Stamp};
use trundle_io::{TrajectoryFile, Warnings, read_map_file, read_trajectory_file};

/// Logs the warnings of an input, one line a kind.
pub fn log_warnings(warnings: &Warnings) {
    warnings.iter().for_each(|warning| tracing::warn!("{warning}"));
}

/// A map of a file; its warnings are logged.
///
/// # Errors
/// Those of [`read_map_file`].
pub fn read_map(file: &Path) -> Result<OccupancyGrid, AppError> {
    let map = read_map_file(file)?;
    log_warnings(&map.warnings);
    Ok(map.grid)
}

/// Two maps of files; warnings of one kind are logged once for both.
///
/// # Errors
/// Those of [`read_map_file`].
pub fn read_two_maps(files: [&Path; 2]) -> Result<[OccupancyGrid; 2], AppError> {
    let [first, second] = files;
    let (mut first, second) = (read_map_file(first)?, read_map_file(second)?);
    first.warnings.extend(second.warnings);
    log_warnings(&first.warnings);
    Ok([first.grid, second.grid])
}

/// Reads a trajectory file in any supported format; its warnings are logged.
///
/// # Errors
/// Those of [`read_trajectory_file`].
pub fn read_trajectory(file: &Path) -> Result<Vec<(Stamp, Pose3)>, AppError> {
    let TrajectoryFile { poses, warnings, .. } = read_trajectory_file(file)?;
    log_warnings(&warnings);
    Ok(poses)
}

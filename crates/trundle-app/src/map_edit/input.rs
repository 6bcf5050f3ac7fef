//! The maps of files, for editing.

use crate::{AppError, log_warnings};
use std::path::Path;
use trundle_core::{Invalid, OccupancyGrid};
use trundle_io::{PictureMap, read_picture_map};
use trundle_mapping::map_edit::upright;

/// A map on the cells of its picture; its warnings are logged.
pub(super) fn read_picture(file: &Path) -> Result<PictureMap, AppError> {
    let map = read_picture_map(file)?;
    log_warnings(&map.warnings);
    Ok(map)
}

/// A map along the axes of its frame; a turned picture is resampled without thicker walls.
pub(super) fn read_upright(file: &Path) -> Result<OccupancyGrid, AppError> {
    let map = read_picture(file)?;
    upright(map.grid, map.map_from_grid).map_err(refused(file))
}

/// An error of a file's content, with the name of the file.
pub(super) fn refused(file: &Path) -> impl Fn(Invalid) -> AppError + '_ {
    move |invalid| AppError::Input(format!("{}: {invalid}", file.display()))
}

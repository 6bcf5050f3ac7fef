//! `trundle map crop`: a part of a map.

use super::box_arg::BoxArg;
use super::input::{read_upright, refused};
use super::output::{EditedMap, size_row, write_edited};
use crate::AppError;
use std::path::Path;
use trundle_io::{OutputFolder, Summary};
use trundle_mapping::map_edit::{cropped, known_part};

/// The part of a map that remains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CropExtent {
    /// The cells that a box touches.
    Box(BoxArg),
    /// The smallest box with all known cells.
    Known,
}

/// Writes the folder of a part of a map; its frame does not change.
///
/// # Errors
/// When the map cannot be read, the part has no cell, or a file cannot be written.
pub fn crop_map(file: &Path, extent: CropExtent, folder: OutputFolder) -> Result<EditedMap, AppError> {
    let grid = read_upright(file)?;
    let part = match extent {
        CropExtent::Box(BoxArg { low, high }) => cropped(&grid, low, high),
        CropExtent::Known => known_part(&grid),
    };
    let part = part.map_err(refused(file))?;
    let rows = vec![size_row(&part)];
    write_edited(&part, &mut Summary::new("map crop"), rows, folder)
}

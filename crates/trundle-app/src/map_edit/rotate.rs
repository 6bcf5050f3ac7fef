//! `trundle map rotate`: a map turned about the origin of its frame.

use super::input::{read_picture, refused};
use super::output::{EditedMap, row, size_row, write_edited};
use crate::AppError;
use std::path::Path;
use trundle_core::Pose2;
use trundle_io::{OutputFolder, PictureMap, Summary, annotations_text, read_annotations};
use trundle_mapping::map_edit::{WallDirection, rotated, wall_direction};

/// Sharpness of the walls in their direction below which a map has no direction, as a multiple of the mean over all directions.
/// Source: ours; a round room has 1.19, the maps of Nav2 and MRPB 1.46 to 5.8.
const MIN_SHARPNESS: f64 = 1.3;

/// The turn of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RotationTarget {
    /// Walls parallel to the axes.
    Walls,
    /// A turn counter-clockwise \[deg\].
    Degrees(f64),
}

impl RotationTarget {
    /// The choices of `--to`: name, help text, value.
    pub const CHOICES: [(&'static str, &'static str, Self); 1] =
        [("walls", "Walls become parallel to the axes, by 45 deg at most", Self::Walls)];
}

/// A turn \[deg\], or the walls.
impl From<Option<f64>> for RotationTarget {
    fn from(degrees: Option<f64>) -> Self {
        degrees.map_or(Self::Walls, Self::Degrees)
    }
}

/// Writes the folder of a rotated map, with the `zones` of the map, a GeoJSON file, turned with it.
///
/// # Errors
/// When a file cannot be read or written, or the map shows no direction of walls.
pub fn rotate_map(
    file: &Path,
    zones: Option<&Path>,
    target: RotationTarget,
    folder: OutputFolder,
) -> Result<EditedMap, AppError> {
    let map = read_picture(file)?;
    let zones = zones.map(read_annotations).transpose()?;
    let mut summary = Summary::new("map rotate");
    let mut rows = Vec::new();
    let turn = match target {
        RotationTarget::Degrees(degrees) => degrees.to_radians(),
        RotationTarget::Walls => {
            let found = walls(file, &map)?;
            summary.set("wall_sharpness", found.sharpness);
            rows.push(row("sharpness of the walls", format!("{:.2}", found.sharpness)));
            found.turn
        }
    };
    let grid = rotated(&map.grid, map.map_from_grid, turn).map_err(refused(file))?;
    summary.set("turn_deg", turn.to_degrees());
    if let Some(zones) = zones {
        let turned = zones.moved(Pose2::new(0.0, 0.0, turn));
        folder.write("zones.geojson", annotations_text(&turned).as_bytes())?;
    }
    rows.insert(0, row("turn about the origin of the map", format!("{:.2} deg", turn.to_degrees())));
    rows.push(size_row(&grid));
    write_edited(&grid, &mut summary, rows, folder)
}

/// The turn that makes the walls parallel to the axes of the map frame.
fn walls(file: &Path, map: &PictureMap) -> Result<WallDirection, AppError> {
    let advice = "give the turn with --by DEG";
    let Some(found) = wall_direction(&map.grid, map.map_from_grid.theta) else {
        let problem = "the map has hardly a wall, expected 30 occupied cells beside free ones";
        return Err(AppError::Input(format!("{}: {problem}; {advice}", file.display())));
    };
    if found.sharpness < MIN_SHARPNESS {
        let problem = format!(
            "the walls have no common direction: they are {:.2} times as sharp in the best direction as in the mean, expected \
             {MIN_SHARPNESS} or more",
            found.sharpness
        );
        return Err(AppError::Input(format!("{}: {problem}; {advice}", file.display())));
    }
    Ok(found)
}

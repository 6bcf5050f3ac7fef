//! A map on the cells of its picture, which may be turned in the map frame.

use super::source::MapSource;
use super::{freed_warning, picture_grid};
use crate::{IoError, Warnings};
use std::path::Path;
use trundle_core::{OccupancyGrid, Pose2, Vector2};

/// A map on the cells of its picture, not resampled.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureMap {
    /// The cells of the picture, along the axes of the picture.
    pub grid: OccupancyGrid,
    /// The pose of the grid's frame in the map frame: the turn by the origin's yaw about the origin.
    pub map_from_grid: Pose2,
    /// Warnings about the file.
    pub warnings: Warnings,
}

/// Reads a map as [`read_map_file`](crate::read_map_file) does, without resampling a turned picture.
///
/// # Errors
/// As [`read_map_file`](crate::read_map_file).
pub fn read_picture_map(yaml_path: &Path) -> Result<PictureMap, IoError> {
    let source = MapSource::read(yaml_path)?;
    let grid = picture_grid(&source)?;
    let mut warnings = Warnings::default();
    freed_warning(&source, &mut warnings);
    let map_from_grid = turned_about(grid.geometry().origin, source.yaml.yaw);
    Ok(PictureMap { grid, map_from_grid, warnings })
}

/// The pose that turns about a point.
fn turned_about(center: Vector2, yaw: f64) -> Pose2 {
    let turn = Pose2::new(0.0, 0.0, yaw);
    let shift = center - turn.rotate(center);
    if turn.theta == 0.0 { Pose2::IDENTITY } else { Pose2::new(shift.x, shift.y, yaw) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{map_pgm, map_yaml, read_map};

    #[test]
    fn a_turned_picture_keeps_its_cells_and_has_a_pose() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.yaml");
        let mut grid = OccupancyGrid::from_ascii(0.5, "#..\n...").unwrap();
        std::fs::write(dir.path().join("m.pgm"), map_pgm(&grid)).unwrap();
        let yaml =
            |yaw: &str| map_yaml(&grid, "m.pgm").replace("[0.0, 0.0, 0.0]", &format!("[1.0, 2.0, {yaw}]"));
        std::fs::write(&path, yaml("0.0")).unwrap();
        assert_eq!(read_picture_map(&path).unwrap().map_from_grid, Pose2::IDENTITY);
        std::fs::write(&path, yaml("1.5707963267948966")).unwrap();
        let found = read_picture_map(&path).unwrap();
        grid = OccupancyGrid::new(*found.grid.geometry(), grid.cells().to_vec()).unwrap();
        assert_eq!(found.grid, grid);
        let upright = read_map(&path).unwrap();
        for i in 0..grid.geometry().len() {
            let cell = grid.geometry().cell(i);
            assert_eq!(
                upright.at(found.map_from_grid.transform(grid.geometry().center(cell))),
                grid.get(cell)
            );
        }
    }
}

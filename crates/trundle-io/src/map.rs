//! Maps in the form of the ROS `map_server`: a PGM picture and a YAML file beside it.

mod graph;
mod mask;
mod pgm;
mod places;
mod turned;
mod yaml;

pub use graph::{GraphFile, read_graph};
pub use mask::{KeepOutFile, SpeedFile, read_keep_out_mask, read_speed_mask};
pub use places::read_places;

use crate::files::{read_bytes, read_text};
use crate::{IoError, OutputFolder};
use pgm::Pgm;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid};
use yaml::MapYaml;

/// Grey of a free cell, as `map_saver` writes it.
const FREE_GREY: u8 = 254;
/// Grey of an occupied cell.
const OCCUPIED_GREY: u8 = 0;
/// Grey of an unknown cell: its occupancy of 0.19608 lies just above the usual `free_thresh`.
const UNKNOWN_GREY: u8 = 205;

/// A map from its YAML file and the PGM picture that it names.
///
/// A pixel's occupancy is `(maxval - v) / maxval`, or `v / maxval` with `negate`; above `occupied_thresh` it is
/// occupied, below `free_thresh` free, between them unknown. In mode `raw` it is `v / 100`, unknown above 100. A picture with a yaw is
/// drawn anew along the map's axes: a cell is occupied that touches an occupied one, so walls may become a cell thicker.
///
/// # Errors
/// When a file is missing or truncated, a field is missing or not accepted, thresholds are out of order, or the picture is
/// larger than 2^28 cells.
pub fn read_map(yaml_path: &Path) -> Result<OccupancyGrid, IoError> {
    let yaml = MapYaml::parse(yaml_path, &read_text(yaml_path)?)?;
    let (pgm_path, pgm) = picture_of(yaml_path, &yaml)?;
    let geometry = GridGeometry::new(yaml.resolution, yaml.origin, pgm.width, pgm.height)
        .map_err(IoError::field(yaml_path))?;
    let rows = pgm.values.chunks_exact(pgm.width).rev(); // the picture's first row is the highest y
    let cells = rows.flatten().map(|&value| yaml.cell(value, pgm.maxval)).collect();
    let rank = |cell| match cell {
        Cell::Occupied => 0,
        Cell::Unknown => 1,
        Cell::Free => 2,
    };
    let (geometry, cells) = turned::straightened(geometry, cells, yaml.yaw, Cell::Unknown, rank)
        .map_err(IoError::field(yaml_path))?;
    OccupancyGrid::new(geometry, cells).map_err(IoError::field(&pgm_path))
}

/// The picture that a map's YAML names, and where it is.
fn picture_of(yaml_path: &Path, yaml: &MapYaml) -> Result<(PathBuf, Pgm), IoError> {
    let pgm_path = yaml_path.parent().unwrap_or(Path::new("")).join(&yaml.image);
    if !pgm_path.exists() {
        let problem = format!("image is '{}', but there is no such file", pgm_path.display());
        return Err(IoError::malformed(yaml_path, problem));
    }
    let pgm = Pgm::parse(&pgm_path, &read_bytes(&pgm_path)?)?;
    Ok((pgm_path, pgm))
}

/// Writes `NAME.pgm` and `NAME.yaml` into the folder, as `map_saver` does: free 254, occupied 0, unknown 205.
///
/// # Errors
/// When a file cannot be written.
pub fn write_map(folder: &OutputFolder, name: &str, grid: &OccupancyGrid) -> Result<(), IoError> {
    folder.write(&format!("{name}.pgm"), &map_pgm(grid))?;
    folder.write(&format!("{name}.yaml"), map_yaml(grid, &format!("{name}.pgm")).as_bytes())
}

/// The picture of a map: a binary PGM, the highest y on top.
pub fn map_pgm(grid: &OccupancyGrid) -> Vec<u8> {
    let GridGeometry { width, height, resolution, .. } = *grid.geometry();
    let mut bytes = format!("P5\n# trundle {resolution} m/px\n{width} {height}\n255\n").into_bytes();
    for row in (0..height).rev() {
        bytes.extend((0..width).map(|col| match grid.get(CellIndex { col, row }) {
            Cell::Free => FREE_GREY,
            Cell::Occupied => OCCUPIED_GREY,
            Cell::Unknown => UNKNOWN_GREY,
        }));
    }
    bytes
}

/// The YAML beside the picture `image`; every number reads back as the same f64.
pub fn map_yaml(grid: &OccupancyGrid, image: &str) -> String {
    let GridGeometry { resolution, origin, .. } = *grid.geometry();
    let mut text = String::new();
    writeln!(text, "image: {image}\nmode: trinary\nresolution: {resolution:?}").expect("invariant: a String");
    writeln!(text, "origin: [{:?}, {:?}, 0.0]", origin.x, origin.y).expect("invariant: a String");
    text.push_str("negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::Vector2;

    fn round_trip(grid: &OccupancyGrid) -> OccupancyGrid {
        let dir = tempfile::tempdir().unwrap();
        let folder = OutputFolder::create(&dir.path().join("out")).unwrap();
        write_map(&folder, "map", grid).unwrap();
        read_map(&folder.commit().unwrap().join("map.yaml")).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn a_map_comes_back_the_same(
            width in 1usize..20, height in 1usize..20, resolution in 1e-9..10f64,
            x in prop::num::f64::NORMAL, y in -1e3..1e3f64, seed in any::<u64>(),
        ) {
            // Of any origin: where the grid cannot hold it, the constructor says so.
            let Ok(geometry) = GridGeometry::new(resolution, Vector2::new(x, y), width, height) else {
                prop_assert!(x.abs() > 1e12 * resolution);
                let near = GridGeometry::new(resolution, Vector2::new(y, y), width, height).unwrap();
                let grid = OccupancyGrid::filled(near, Cell::Free);
                prop_assert_eq!(round_trip(&grid), grid);
                return Ok(());
            };
            let cell = |i: usize| [Cell::Unknown, Cell::Free, Cell::Occupied][(seed >> (i % 60)) as usize % 3];
            let grid = OccupancyGrid::new(geometry, (0..width * height).map(cell).collect()).unwrap();
            prop_assert_eq!(round_trip(&grid), grid);
        }
    }

    #[test]
    fn an_origin_beyond_all_cells_is_refused_by_file_and_field() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.yaml");
        let grid = OccupancyGrid::from_ascii(0.05, "#").unwrap();
        let yaml = map_yaml(&grid, "m.pgm").replace("origin: [0.0,", "origin: [8.126587341910605e94,");
        std::fs::write(&path, yaml).unwrap();
        std::fs::write(dir.path().join("m.pgm"), map_pgm(&grid)).unwrap();
        let error = read_map(&path).unwrap_err().to_string();
        assert!(error.contains("m.yaml") && error.contains("origin x is 81265873"), "{error}");
    }

    #[test]
    fn a_missing_picture_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.yaml");
        let grid = OccupancyGrid::from_ascii(0.05, "#").unwrap();
        std::fs::write(&path, map_yaml(&grid, "nowhere.pgm")).unwrap();
        let error = read_map(&path).unwrap_err().to_string();
        assert!(error.contains("m.yaml: image is '") && error.contains("nowhere.pgm'"), "{error}");
    }
}

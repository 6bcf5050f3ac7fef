//! An occupancy grid as text of runs, in recordings and messages: `12u3f1o` is 12 unknown, 3 free and 1 occupied cell.

use crate::{Cell, GridGeometry, Invalid, OccupancyGrid, Vector2};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use std::fmt::Write;

/// Largest number of cells that a text may hold: 350 x 350 m in cells of 5 cm. A short text of long runs fills no memory. Source: ours.
pub const MAX_TEXT_CELLS: usize = 50_000_000;

/// An occupancy grid as text.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct GridText {
    /// Side of a cell \[m\].
    resolution_m: f64,
    /// Lower-left corner of cell (0, 0), map frame \[m\].
    origin_m: [f64; 2],
    /// Columns.
    width: usize,
    /// Rows.
    height: usize,
    /// Runs of cells, row by row from the lowest y.
    cells: String,
}

impl From<&OccupancyGrid> for GridText {
    fn from(grid: &OccupancyGrid) -> Self {
        let GridGeometry { resolution, origin, width, height } = *grid.geometry();
        let mut cells = String::new();
        for run in grid.cells().chunk_by(|a, b| a == b) {
            // Writing to a string does not fail.
            _ = write!(cells, "{}{}", run.len(), letter(run[0]));
        }
        Self { resolution_m: resolution, origin_m: [origin.x, origin.y], width, height, cells }
    }
}

impl TryFrom<GridText> for OccupancyGrid {
    type Error = Invalid;

    fn try_from(text: GridText) -> Result<Self, Invalid> {
        let origin = Vector2::new(text.origin_m[0], text.origin_m[1]);
        let geometry = GridGeometry::new(text.resolution_m, origin, text.width, text.height)?;
        if geometry.len() > MAX_TEXT_CELLS {
            let expected = format!("at most {MAX_TEXT_CELLS}");
            return Err(Invalid::new("number of cells", geometry.len(), "", expected));
        }
        Self::new(geometry, cells(&text.cells, geometry.len())?)
    }
}

impl Serialize for OccupancyGrid {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        GridText::from(self).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for OccupancyGrid {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::try_from(GridText::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}

fn letter(cell: Cell) -> char {
    match cell {
        Cell::Unknown => 'u',
        Cell::Free => 'f',
        Cell::Occupied => 'o',
    }
}

/// The cells of the runs, which must be `count`.
fn cells(runs: &str, count: usize) -> Result<Vec<Cell>, Invalid> {
    let mut cells = Vec::new();
    for run in runs.split_inclusive(|c: char| !c.is_ascii_digit()) {
        let bad = || Invalid::new("run of cells", run, "", "a number and u, f or o, as 12u");
        let cell = match run.chars().next_back() {
            Some('u') => Cell::Unknown,
            Some('f') => Cell::Free,
            Some('o') => Cell::Occupied,
            _ => return Err(bad()),
        };
        let length: usize = run[..run.len() - 1].parse().map_err(|_| bad())?;
        if length > count - cells.len() {
            return Err(Invalid::new("number of cells", "more than the grid has", "", count.to_string()));
        }
        cells.resize(cells.len() + length, cell);
    }
    Ok(cells)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(cells: &str, width: usize, height: usize) -> Result<OccupancyGrid, String> {
        let text = format!(
            r#"{{"resolution_m":0.05,"origin_m":[0,0],"width":{width},"height":{height},"cells":"{cells}"}}"#
        );
        serde_json::from_str(&text).map_err(|error| error.to_string())
    }

    #[test]
    fn runs_are_read_and_written() {
        let grid = OccupancyGrid::from_ascii(0.05, "?..\n##.\n").unwrap();
        let text = serde_json::to_string(&grid).unwrap();
        assert!(text.contains(r#""cells":"2o1f1u2f""#), "{text}");
        assert_eq!(serde_json::from_str::<OccupancyGrid>(&text).unwrap(), grid);
    }

    #[test]
    fn wrong_texts_are_refused_with_what_is_wrong() {
        assert!(read("6u", 3, 2).is_ok());
        for (cells, what) in [
            ("5u", "number of cells"),
            ("7u", "number of cells"),
            ("6x", "run of cells"),
            ("6", "run of cells"),
        ] {
            assert!(read(cells, 3, 2).unwrap_err().contains(what), "{cells}");
        }
        assert!(read("u", 1, 1).unwrap_err().contains("run of cells"));
        assert!(read("6é", 3, 2).unwrap_err().contains("run of cells"), "a letter of two bytes");
        assert!(read("99999999999999999999u", 3, 2).is_err());
        assert!(read("1000000000u", 40_000, 25_000).unwrap_err().contains("at most 50000000"));
    }

    proptest! {
        #[test]
        fn every_grid_survives(cells in proptest::collection::vec(0..3_u8, 1..60)) {
            let cell = |k: &u8| [Cell::Unknown, Cell::Free, Cell::Occupied][usize::from(*k)];
            let geometry = GridGeometry::new(0.1, Vector2::new(-0.3, 0.7), cells.len(), 1).unwrap();
            let grid = OccupancyGrid::new(geometry, cells.iter().map(cell).collect()).unwrap();
            let text = serde_json::to_string(&grid).unwrap();
            prop_assert_eq!(serde_json::from_str::<OccupancyGrid>(&text).unwrap(), grid);
        }
    }
}

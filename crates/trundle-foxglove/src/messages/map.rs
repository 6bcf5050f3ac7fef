//! `/map`: the known part of the map as coloured cells.

use super::{MAP_FRAME, pose3, timestamp};
use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{Grid, PackedElementField, Vector2};
use trundle_app::operator::RunView;
use trundle_core::{Cell, CellIndex, OccupancyGrid, Pose2, Stamp};

/// Bytes of a cell: red, green, blue, opacity.
const CELL_BYTES: u32 = 4;

/// The map of a view.
pub fn message(view: &RunView) -> Option<(Stamp, Grid)> {
    let grid = &view.map.as_ref()?.grid;
    let part = KnownPart::of(grid)?;
    let cell = grid.geometry().resolution;
    let corner =
        grid.geometry().origin + trundle_core::Vector2::new(part.left as f64, part.bottom as f64) * cell;
    let columns = part.columns() as u32;
    let message = Grid {
        timestamp: Some(timestamp(view.stamp)),
        frame_id: MAP_FRAME.to_owned(),
        pose: Some(pose3(Pose2::new(corner.x, corner.y, 0.0))),
        column_count: columns,
        cell_size: Some(Vector2 { x: cell, y: cell }),
        row_stride: columns * CELL_BYTES,
        cell_stride: CELL_BYTES,
        fields: (0..).zip(["red", "green", "blue", "alpha"]).map(field).collect(),
        data: part.cells(grid).flat_map(color).collect::<Vec<u8>>().into(),
    };
    Some((view.stamp, message))
}

fn field((offset, name): (u32, &str)) -> PackedElementField {
    PackedElementField { name: name.to_owned(), offset, r#type: NumericType::Uint8.into() }
}

/// Red, green, blue and opacity of a cell; an unknown one is transparent.
fn color(cell: Cell) -> [u8; CELL_BYTES as usize] {
    match cell {
        Cell::Free => [235, 235, 235, 255],
        Cell::Occupied => [30, 30, 30, 255],
        Cell::Unknown => [0; 4],
    }
}

/// The smallest rectangle with all known cells.
#[derive(Debug, PartialEq, Eq)]
struct KnownPart {
    left: usize,
    right: usize,
    bottom: usize,
    top: usize,
}

impl KnownPart {
    /// `None` for a map without a known cell.
    fn of(grid: &OccupancyGrid) -> Option<Self> {
        let mut part: Option<Self> = None;
        for (row, cells) in (0..).zip(grid.cells().chunks_exact(grid.geometry().width)) {
            let is_known = |cell: &Cell| *cell != Cell::Unknown;
            let Some(left) = cells.iter().position(is_known) else { continue };
            let right = cells.iter().rposition(is_known).unwrap_or(left);
            let known = part.get_or_insert(Self { left, right, bottom: row, top: row });
            *known = Self {
                left: known.left.min(left),
                right: known.right.max(right),
                top: row,
                bottom: known.bottom,
            };
        }
        part
    }

    fn columns(&self) -> usize {
        self.right - self.left + 1
    }

    /// The cells, row by row from the bottom.
    fn cells<'g>(&'g self, grid: &'g OccupancyGrid) -> impl Iterator<Item = Cell> + 'g {
        let row = move |row| (self.left..=self.right).map(move |col| grid.get(CellIndex { col, row }));
        (self.bottom..=self.top).flat_map(row)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_known_part_is_sent() {
        let grid = OccupancyGrid::from_ascii(0.1, "?????\n?#.??\n??.??\n?????").unwrap();
        let part = KnownPart::of(&grid).unwrap();
        assert_eq!(part, KnownPart { left: 1, right: 2, bottom: 1, top: 2 });
        assert_eq!(
            part.cells(&grid).collect::<Vec<_>>(),
            [Cell::Unknown, Cell::Free, Cell::Occupied, Cell::Free]
        );
        let unknown = OccupancyGrid::filled(*grid.geometry(), Cell::Unknown);
        assert_eq!(KnownPart::of(&unknown), None);
    }
}

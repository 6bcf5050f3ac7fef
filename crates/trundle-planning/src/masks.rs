use crate::area::area;
use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, Pose2, Vector2};

/// Speed limits over an area, as Nav2's speed masks give them: a limit a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedMask {
    geometry: GridGeometry,
    limits: Vec<f32>,
}

impl SpeedMask {
    /// A mask of `limits`, m/s, row by row from the lowest y. Infinite: no limit.
    ///
    /// # Errors
    /// When the number of cells is not the geometry's, or a limit is not above 0 (a robot would stand there for ever).
    pub fn new(geometry: GridGeometry, limits: Vec<f32>) -> Result<Self, Invalid> {
        if limits.len() != geometry.len() {
            return Err(Invalid::new(
                "cells of the speed mask",
                limits.len(),
                "",
                geometry.len().to_string(),
            ));
        }
        match limits.iter().find(|limit| limit.is_nan() || **limit <= 0.0) {
            Some(limit) => Err(Invalid::new("limit of the speed mask", limit, "m/s", "more than 0")),
            None => Ok(Self { geometry, limits }),
        }
    }

    /// The limit at a point of the map frame, m/s; infinite outside the mask.
    pub fn limit(&self, point: Vector2) -> f64 {
        let cell = self.geometry.cell_at(point).map(|cell| self.limits[self.geometry.linear(cell)]);
        cell.map_or(f64::INFINITY, f64::from)
    }
}

/// How dear places are, cell by cell, from 0 to 100 per cent of [`RoomConfig::mask_weight`]: to be avoided, not forbidden.
///
/// [`RoomConfig::mask_weight`]: crate::RoomConfig::mask_weight
#[derive(Debug, Clone, PartialEq)]
pub struct DearMask {
    geometry: GridGeometry,
    values: Vec<u8>,
}

impl DearMask {
    /// A mask of `values`, row by row from the lowest y.
    ///
    /// # Errors
    /// When there are not as many values as cells, or one is above 100.
    pub fn new(geometry: GridGeometry, values: Vec<u8>) -> Result<Self, Invalid> {
        if values.len() != geometry.len() {
            let expected = geometry.len().to_string();
            return Err(Invalid::new("number of values of the mask", values.len(), "", expected));
        }
        match values.iter().find(|value| **value > 100) {
            Some(value) => Err(Invalid::new("value of the mask", value, "", "0 to 100")),
            None => Ok(Self { geometry, values }),
        }
    }

    /// How dear a point of the map frame is, 0 to 1; 0 outside the mask.
    pub(crate) fn share(&self, point: Vector2) -> f64 {
        let cell = self.geometry.cell_at(point).map(|cell| self.values[self.geometry.linear(cell)]);
        f64::from(cell.unwrap_or(0)) / 100.0
    }
}

/// The grid with everything occupied that a keep-out mask touches; the mask may have a lattice of its own. With `grow`, the
/// grid grows to hold what the mask forbids beside it.
///
/// # Errors
/// When it would grow out of proportion.
pub(crate) fn kept_out(
    grid: &OccupancyGrid,
    mask: &OccupancyGrid,
    grow: bool,
) -> Result<OccupancyGrid, Invalid> {
    let forbidden = || mask.cells().iter().enumerate().filter(|(_, cell)| **cell == Cell::Occupied);
    let square = |linear: usize| {
        let (centre, half) =
            (mask.geometry().center(mask.geometry().cell(linear)), mask.geometry().resolution / 2.0);
        (centre - Vector2::repeat(half), centre + Vector2::repeat(half))
    };
    let mut merged = grid.clone();
    if grow && let Some((first, _)) = forbidden().next() {
        let whole = forbidden().fold(square(first), |(low, high), (linear, _)| {
            let (a, b) = square(linear);
            (low.inf(&a), high.sup(&b))
        });
        merged = cut(grid, area(grid.geometry(), whole.0, whole.1, 0.0)?);
    }
    forbidden().for_each(|(linear, _)| occupy(&mut merged, square(linear)));
    Ok(merged)
}

/// The grid over another geometry of its lattice; what it does not hold is unknown.
pub(crate) fn cut(grid: &OccupancyGrid, geometry: GridGeometry) -> OccupancyGrid {
    if geometry == *grid.geometry() {
        return grid.clone();
    }
    let cells = (0..geometry.len()).map(|linear| grid.at(geometry.center(geometry.cell(linear))));
    OccupancyGrid::new(geometry, cells.collect()).expect("invariant: a cell for each")
}

/// Occupies the cells that a box overlaps.
fn occupy(grid: &mut OccupancyGrid, (low, high): (Vector2, Vector2)) {
    /// Overlaps thinner than this, as a share of a cell, are rounding.
    const TOUCH: f64 = 1e-6;
    let GridGeometry { resolution, origin, width, height } = *grid.geometry();
    let span = |low: f64, high: f64, size: usize| {
        let first = (low / resolution + TOUCH).floor().clamp(0.0, size as f64);
        let end = (high / resolution - TOUCH).ceil().clamp(0.0, size as f64);
        first as usize..end as usize
    };
    let (low, high) = (low - origin, high - origin);
    for row in span(low.y, high.y, height) {
        for col in span(low.x, high.x, width) {
            grid.set(CellIndex { col, row }, Cell::Occupied);
        }
    }
}

/// Whether what the robot's front comes to at a pose was ever seen.
pub(crate) fn is_unseen(grid: &OccupancyGrid, pose: Pose2, radius: f64) -> bool {
    grid.at(pose.position() + pose.direction() * radius) == Cell::Unknown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_looked_up_and_checked() {
        let geometry = GridGeometry::new(0.5, Vector2::zeros(), 2, 1).unwrap();
        let mask = SpeedMask::new(geometry, vec![0.2, f32::INFINITY]).unwrap();
        assert_eq!(mask.limit(Vector2::new(0.1, 0.1)), f64::from(0.2_f32));
        assert_eq!(mask.limit(Vector2::new(0.7, 0.1)), f64::INFINITY);
        assert_eq!(mask.limit(Vector2::new(9.0, 0.1)), f64::INFINITY);
        assert!(SpeedMask::new(geometry, vec![0.0, 1.0]).is_err());
        assert!(SpeedMask::new(geometry, vec![1.0]).is_err());
    }

    #[test]
    fn a_finer_mask_forbids_every_cell_that_it_touches() {
        let grid = OccupancyGrid::from_ascii(0.1, "....\n....\n....").unwrap();
        let geometry = GridGeometry::new(0.02, Vector2::new(0.12, 0.0), 1, 20).unwrap();
        let thin = OccupancyGrid::filled(geometry, Cell::Occupied);
        let merged = kept_out(&grid, &thin, false).unwrap();
        assert_eq!(merged, OccupancyGrid::from_ascii(0.1, ".#..\n.#..\n.#..").unwrap());
        let wider = kept_out(&grid, &thin, true).unwrap();
        assert!(wider.geometry().height > 3 && wider.at(Vector2::new(0.13, 0.39)) == Cell::Occupied);
        assert_eq!(
            (wider.at(Vector2::new(0.05, 0.39)), wider.at(Vector2::new(0.05, 0.05))),
            (Cell::Unknown, Cell::Free)
        );
    }

    #[test]
    fn a_mask_on_the_same_lattice_forbids_its_own_cells() {
        let grid = OccupancyGrid::filled(
            GridGeometry::new(0.05, Vector2::new(-3.1, 2.7), 70, 40).unwrap(),
            Cell::Free,
        );
        let mut mask = grid.clone();
        for (col, row) in [(0, 0), (69, 39), (33, 17), (34, 17)] {
            mask.set(CellIndex { col, row }, Cell::Occupied);
        }
        assert_eq!(kept_out(&grid, &mask, false).unwrap(), mask);
    }
}

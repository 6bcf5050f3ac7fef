//! Agreement of an estimated occupancy grid with the true grid.

use crate::{ErrorStatistics, EvalError, Side, occupied_cells::OccupiedCells};
use serde::{Deserialize, Serialize};
use trundle_core::{Cell, CellIndex, Invalid, OccupancyGrid, Pose2, Vector2, require_in};

/// Settings of the comparison of a map with the true map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct MapAgreementConfig {
    /// Largest distance between the centres of occupied cells that agree, m, 0.001 to 10. Default 0.05.
    pub within: f64,
    /// A true obstacle is evaluated if the map has known cells within this distance, m, 0 to 10. Default 0.1.
    pub seen_within: f64,
    /// Distances are cut at this, m, 0.01 to 100. Default 2.
    pub reach: f64,
}

impl Default for MapAgreementConfig {
    fn default() -> Self {
        Self { within: 0.05, seen_within: 0.1, reach: 2.0 }
    }
}

impl MapAgreementConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range of its field.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("within", self.within, "m", 0.001, 10.0)?;
        require_in("seen_within", self.seen_within, "m", 0.0, 10.0)?;
        require_in("reach", self.reach, "m", self.within.max(0.01), 100.0)?;
        Ok(self)
    }
}

/// Agreement of a map with the true one.
#[derive(Debug, Clone, PartialEq)]
pub struct MapAgreement {
    /// Distances from each occupied cell of the map to the nearest truly occupied one, centre to centre, m.
    pub to_truth: ErrorStatistics,
    /// Part of the map's occupied cells within `within` of a truly occupied one, 0 to 1.
    pub precision: f64,
    /// Distances from each observable true surface cell to the nearest occupied cell of the map, m.
    pub from_truth: ErrorStatistics,
    /// Part of these within `within`, 0 to 1.
    pub recall: f64,
    /// Part of the map's free cells that are truly occupied with all their neighbours, 0 to 1: walls cleared by mistake.
    pub cleared: f64,
    /// Number of all true surface cells, including those that were not observable.
    pub surface_cells: usize,
}

/// Compares the occupied cells of `estimate` with those of `truth`; `truth_from_estimate` is the transform to the frame of `truth`.
///
/// A surface cell is a truly occupied one with a free cell among its eight neighbours. Insides of walls do not count.
///
/// # Errors
/// When a map has no occupied cell (the truth: no observable surface), the pose is not finite, or the configuration is out of range.
pub fn map_agreement(
    truth: &OccupancyGrid,
    estimate: &OccupancyGrid,
    truth_from_estimate: Pose2,
    config: &MapAgreementConfig,
) -> Result<MapAgreement, EvalError> {
    let config = config.clone().validated()?;
    if !truth_from_estimate.is_finite() {
        return Err(Invalid::new("truth_from_estimate", "not finite", "m, m, rad", "finite numbers").into());
    }
    let (true_cells, cells) = (OccupiedCells::of(truth), OccupiedCells::of(estimate));
    let away = |from: Vector2, to: &OccupiedCells| {
        to.nearest(from, config.reach).map_or(config.reach, |near| (near - from).norm())
    };
    let to_truth: Vec<f64> =
        cells.centers().map(|center| away(truth_from_estimate.transform(center), &true_cells)).collect();
    let back = truth_from_estimate.inverse();
    let surface: Vec<Vector2> = surface(truth).map(|center| back.transform(center)).collect();
    let seen = surface.iter().filter(|center| is_known(estimate, **center, config.seen_within));
    let from_truth: Vec<f64> = seen.map(|center| away(*center, &cells)).collect();
    let statistics =
        |side, distances: &[f64]| ErrorStatistics::of(distances).ok_or(EvalError::NoObstacle { side });
    Ok(MapAgreement {
        precision: share(&to_truth, config.within),
        to_truth: statistics(Side::Estimate, &to_truth)?,
        recall: share(&from_truth, config.within),
        from_truth: statistics(Side::Reference, &from_truth)?,
        cleared: cleared(truth, estimate, truth_from_estimate),
        surface_cells: surface.len(),
    })
}

/// Part of the distances that are at most `limit`, give or take the last bits.
fn share(distances: &[f64], limit: f64) -> f64 {
    let near = distances.iter().filter(|d| **d <= limit * (1.0 + 1e-9)).count();
    near as f64 / distances.len().max(1) as f64
}

/// The centres of the occupied cells that have a free neighbour.
fn surface(grid: &OccupancyGrid) -> impl Iterator<Item = Vector2> + '_ {
    let geometry = *grid.geometry();
    let cells = (0..geometry.len()).map(move |i| geometry.cell(i));
    let occupied = cells.filter(move |cell| grid.get(*cell) == Cell::Occupied);
    let open = occupied.filter(move |cell| neighbours(grid, *cell).any(|cell| cell == Cell::Free));
    open.map(move |cell| geometry.center(cell))
}

/// The eight neighbours of a cell, without those off the grid.
fn neighbours(grid: &OccupancyGrid, cell: CellIndex) -> impl Iterator<Item = Cell> + '_ {
    let (width, height) = (grid.geometry().width, grid.geometry().height);
    let cols = cell.col.saturating_sub(1)..(cell.col + 2).min(width);
    let rows = cell.row.saturating_sub(1)..(cell.row + 2).min(height);
    let all = rows.flat_map(move |row| cols.clone().map(move |col| CellIndex { col, row }));
    all.filter(move |other| *other != cell).map(|other| grid.get(other))
}

/// Whether the map has a known cell whose centre is within `reach` m of a point.
fn is_known(grid: &OccupancyGrid, point: Vector2, reach: f64) -> bool {
    let step = grid.geometry().resolution;
    let cells = (reach / step).ceil() as i64;
    let mut offsets = (-cells..=cells).flat_map(|y| (-cells..=cells).map(move |x| (x as f64, y as f64)));
    offsets.any(|(x, y)| {
        let offset = Vector2::new(x, y) * step;
        offset.norm() <= reach && grid.at(point + offset) != Cell::Unknown
    })
}

/// Part of the estimate's free cells inside true obstacles.
fn cleared(truth: &OccupancyGrid, estimate: &OccupancyGrid, truth_from_estimate: Pose2) -> f64 {
    let geometry = *estimate.geometry();
    let (mut free, mut inside) = (0_usize, 0_usize);
    for (i, _) in estimate.cells().iter().enumerate().filter(|(_, cell)| **cell == Cell::Free) {
        free += 1;
        let center = truth_from_estimate.transform(geometry.center(geometry.cell(i)));
        let Some(cell) = truth.geometry().cell_at(center) else { continue };
        let solid = truth.get(cell) == Cell::Occupied;
        inside += usize::from(solid && neighbours(truth, cell).all(|other| other == Cell::Occupied));
    }
    inside as f64 / free.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(art: &str) -> OccupancyGrid {
        OccupancyGrid::from_ascii(0.1, art).unwrap()
    }

    fn config(within: f64) -> MapAgreementConfig {
        MapAgreementConfig { within, ..Default::default() }
    }

    const TRUTH: &str = "\
        ..........
        .########.
        ..........
        ..........";

    #[test]
    fn a_wall_a_cell_off_at_one_end_by_hand() {
        // Eight cells, two of them one cell too low; another cell in free space, 0.2 m below the wall.
        let estimate = grid(
            "..........
             .######...
             .......##.
             ..#.......",
        );
        let found = map_agreement(&grid(TRUTH), &estimate, Pose2::IDENTITY, &config(0.05)).unwrap();
        assert!((found.precision - 6.0 / 9.0).abs() < 1e-12);
        assert!((found.to_truth.mean - (2.0 * 0.1 + 0.2) / 9.0).abs() < 1e-12);
        assert!((found.to_truth.max - 0.2).abs() < 1e-12);
        // All eight true cells were observable; six are exact, two have their nearest cell one cell away.
        assert_eq!((found.from_truth.count, found.surface_cells), (8, 8));
        assert!((found.recall - 0.75).abs() < 1e-12 && (found.from_truth.max - 0.1).abs() < 1e-12);
        let wide = map_agreement(&grid(TRUTH), &estimate, Pose2::IDENTITY, &config(0.1)).unwrap();
        assert!((wide.precision - 8.0 / 9.0).abs() < 1e-12 && wide.recall == 1.0);
    }

    #[test]
    fn obstacles_never_observed_are_not_missed() {
        let half = grid(
            ".....?????
             .####?????
             .....?????
             .....?????",
        );
        let found = map_agreement(&grid(TRUTH), &half, Pose2::IDENTITY, &config(0.05)).unwrap();
        // The fifth cell of the wall is one cell outside the last known column, and counts as observable: its nearest cell is 0.1 m away.
        assert_eq!(found.from_truth.count, 5);
        assert_eq!((found.precision, found.recall), (1.0, 0.8));
    }

    #[test]
    fn maps_in_other_frames_are_led_there() {
        // Two neighbouring cells at the origin's corner, in a map rotated by 90 degrees and moved.
        let truth = grid("....\n....\n.##.\n....");
        let estimate = grid("....\n..#.\n..#.\n....");
        // truth = R(-90 deg) estimate + t: (0.25, 0.15) and (0.25, 0.25) become (0.15, 0.15) and (0.25, 0.15).
        let pose = Pose2::new(0.0, 0.4, -std::f64::consts::FRAC_PI_2);
        let found = map_agreement(&truth, &estimate, pose, &config(0.01)).unwrap();
        assert!(found.precision == 1.0 && found.to_truth.max < 1e-12, "{found:?}");
    }

    #[test]
    fn walls_that_were_cleared_are_counted() {
        let truth = grid("#####\n#####\n#####\n.....");
        let estimate = grid("?????\n??.??\n#####\n.....");
        let found = map_agreement(&truth, &estimate, Pose2::IDENTITY, &config(0.05)).unwrap();
        assert!((found.cleared - 1.0 / 6.0).abs() < 1e-12);
        assert_eq!(found.surface_cells, 5);
    }

    #[test]
    fn empty_maps_are_refused() {
        let empty = grid("..\n..");
        let refuse = |a: &OccupancyGrid, b: &OccupancyGrid| {
            map_agreement(a, b, Pose2::IDENTITY, &config(0.05)).unwrap_err().to_string()
        };
        assert_eq!(refuse(&grid(TRUTH), &empty), "the estimate map has no obstacle to compare");
        assert_eq!(refuse(&empty, &grid(TRUTH)), "the reference map has no obstacle to compare");
        let nowhere = Pose2 { x: f64::NAN, ..Pose2::IDENTITY };
        assert!(map_agreement(&empty, &empty, nowhere, &config(0.05)).is_err());
        assert_eq!(config(0.0).validated().unwrap_err().field, "within");
    }
}

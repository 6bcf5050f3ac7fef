//! The direction of the walls of a map.
//!
//! Problem: a map has the heading that the robot had at its start; plans of buildings lie along the axes. Idea: the occupied cells of a
//! wall that is parallel to an axis share a coordinate. The histograms of both coordinates are therefore sharpest at the direction of the
//! walls: as in the deskewing of scanned pages \[Postl86\]. Each cell is a square of samples, so the lattice of the map has no sharp
//! direction of its own. Lines through the faces of the walls refine the direction. Cost: a pass over the surface cells of the map for each
//! of 180 turns.

mod surface;
mod wall_faces;

pub(super) use surface::is_surface;

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use surface::{SurfaceCell, surface_cells};
use trundle_core::{OccupancyGrid, Vector2};
use wall_faces::fitted;

/// Samples along the side of a cell. Source: ours.
const SAMPLES_PER_SIDE: usize = 4;
/// Side of a bin of a histogram \[cells\]. Source: ours.
const BIN_SIDE_CELLS: f64 = 0.25;
/// Bins on either side over which a histogram is smoothed: 1 cell. Source: ours.
const SMOOTHING_BINS: usize = 4;
/// Step of the first search \[rad\]: 0.5 deg, across which a wall of 6 m spreads over a cell. Source: ours.
const FIRST_STEP_RAD: f64 = FRAC_PI_4 / 90.0;
/// Maximum number of surface cells that are used. Source: ours.
const MAX_SURFACE_CELLS: usize = 60_000;
/// Smallest number of surface cells that show a direction. Source: ours, 1.5 m of wall at 5 cm.
const MIN_SURFACE_CELLS: usize = 30;

/// The direction of the walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallDirection {
    /// The turn after which the walls are parallel to the axes \[rad\], in (-pi/4, pi/4].
    pub turn: f64,
    /// Sharpness of the walls in this direction, as a multiple of the mean over all directions: 1 for a map without a direction.
    pub sharpness: f64,
}

/// The direction in which the walls of a map are sharpest, in a frame in which the grid has this heading \[rad\]; `None` for a map with
/// hardly a wall.
#[must_use]
pub fn wall_direction(grid: &OccupancyGrid, heading: f64) -> Option<WallDirection> {
    let cells = surface_cells(grid);
    if cells.len() < MIN_SURFACE_CELLS {
        return None;
    }
    let points = samples(&cells);
    let first: Vec<(f64, f64)> = (-89..=90)
        .map(|step| f64::from(step) * FIRST_STEP_RAD)
        .map(|turn| (turn, sharpness(&points, turn)))
        .collect();
    let mean = first.iter().map(|(_, value)| value).sum::<f64>() / first.len() as f64;
    let best = sharpest(first);
    let turn = fitted(&cells, best.0);
    Some(WallDirection { turn: within_half_a_quarter(turn - heading), sharpness: best.1 / mean })
}

/// The entry of the largest value; the first of equal ones.
fn sharpest(found: Vec<(f64, f64)>) -> (f64, f64) {
    let best = found.into_iter().reduce(|best, next| if next.1 > best.1 { next } else { best });
    best.expect("invariant: there is a turn")
}

/// The same direction of walls in (-pi/4, pi/4].
fn within_half_a_quarter(turn: f64) -> f64 {
    let quarters = ((turn - FRAC_PI_4) / FRAC_PI_2).ceil();
    turn - quarters * FRAC_PI_2
}

/// Samples of surface cells \[cells\].
fn samples(cells: &[SurfaceCell]) -> Vec<Vector2> {
    let stride = cells.len().div_ceil(MAX_SURFACE_CELLS).max(1);
    let part = |k: usize| (k as f64 + 0.5) / SAMPLES_PER_SIDE as f64 - 0.5;
    let of_cell = |cell: &SurfaceCell| {
        let center = cell.center;
        (0..SAMPLES_PER_SIDE * SAMPLES_PER_SIDE)
            .map(move |k| center + Vector2::new(part(k % SAMPLES_PER_SIDE), part(k / SAMPLES_PER_SIDE)))
    };
    cells.iter().step_by(stride).flat_map(of_cell).collect()
}

/// Sum of the squares of both smoothed histograms after a turn.
fn sharpness(points: &[Vector2], turn: f64) -> f64 {
    let (sin, cos) = turn.sin_cos();
    let reach = points.iter().map(|p| p.norm_squared()).fold(0.0, f64::max).sqrt();
    let bins = (2.0 * reach / BIN_SIDE_CELLS).ceil() as usize + 1 + 2 * SMOOTHING_BINS;
    let mut along = [vec![0.0_f64; bins], vec![0.0_f64; bins]];
    let bin = |v: f64| ((v + reach) / BIN_SIDE_CELLS) as usize + SMOOTHING_BINS;
    for p in points {
        along[0][bin(cos * p.x - sin * p.y)] += 1.0;
        along[1][bin(sin * p.x + cos * p.y)] += 1.0;
    }
    along.iter().map(|histogram| smooth_square_sum(histogram)).sum()
}

/// Sum over all pairs of bins less than a cell apart, weighted by a tent.
fn smooth_square_sum(histogram: &[f64]) -> f64 {
    let pair =
        |apart: usize| -> f64 { histogram[apart..].iter().zip(histogram).map(|(a, b)| a * b).sum::<f64>() };
    let weight = |apart: usize| 1.0 - apart as f64 / SMOOTHING_BINS as f64;
    pair(0) + (1..SMOOTHING_BINS).map(|apart| 2.0 * weight(apart) * pair(apart)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Cell, GridGeometry, Pose2};

    /// Three rooms with walls of `thick` m, drawn at an angle on cells of 5 cm.
    fn drawn(turn: f64, thick: f64) -> OccupancyGrid {
        let geometry = GridGeometry::new(0.05, Vector2::new(-9.0, -9.0), 360, 360).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Unknown);
        for i in 0..geometry.len() {
            let cell = geometry.cell(i);
            let p = Pose2::new(0.0, 0.0, -turn).transform(geometry.center(cell));
            let is_inside = p.x.abs() < 5.0 && p.y.abs() < 3.0;
            let is_near = |v: f64, wall: f64| (v - wall).abs() < thick / 2.0;
            let is_outer =
                is_near(p.x.abs(), 5.0) && p.y.abs() < 3.0 || is_near(p.y.abs(), 3.0) && p.x.abs() < 5.0;
            let is_inner = is_near(p.x, 1.2) && p.y < 1.7 || is_near(p.y, -0.4) && p.x < -0.9;
            if is_outer || is_inside && is_inner {
                grid.set(cell, Cell::Occupied);
            } else if is_inside {
                grid.set(cell, Cell::Free);
            }
        }
        grid
    }

    #[test]
    fn the_walls_of_a_flat_are_found_to_a_tenth_of_a_degree() {
        for thick in [0.06, 0.1, 0.2] {
            for k in -44..=45 {
                // Half a degree beside the lattice, few steps of 10 m of wall show the turn.
                let limit = if k == 0 { 0.2 } else { 0.1 };
                let turn = f64::from(k) + 0.37;
                let found = wall_direction(&drawn(turn.to_radians(), thick), 0.0).unwrap();
                let error = within_half_a_quarter(found.turn + turn.to_radians()).to_degrees();
                let error = if error.abs() > 44.0 { error - 45.0_f64.copysign(error) } else { error };
                assert!(error.abs() < limit, "walls of {thick} m at {turn} deg: {error} deg off");
                assert!(found.sharpness > 1.5, "{found:?}");
            }
        }
    }

    #[test]
    fn a_round_room_has_no_direction() {
        let geometry = GridGeometry::new(0.05, Vector2::zeros(), 200, 200).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Unknown);
        for i in 0..geometry.len() {
            let cell = geometry.cell(i);
            let radius = (geometry.center(cell) - Vector2::repeat(5.0)).norm();
            if radius < 4.0 {
                grid.set(cell, if radius > 3.9 { Cell::Occupied } else { Cell::Free });
            }
        }
        let found = wall_direction(&grid, 0.0).unwrap();
        assert!(found.sharpness < 1.3, "{found:?}");
        assert_eq!(wall_direction(&OccupancyGrid::filled(geometry, Cell::Free), 0.0), None);
    }
}

//! Registration of an estimated grid on the true grid by iterated closest points.

use crate::{EvalError, Side, occupied_cells::OccupiedCells};
use trundle_core::{Invalid, OccupancyGrid, Pose2, Vector2};

/// Rounds of pairing and moving. Source: ours.
const ALIGNMENT_ROUNDS: usize = 60;
/// Cells are paired as far as this at first, m, and in the end. Source: ours.
const PAIRING_RADII_M: (f64, f64) = (0.8, 0.15);

/// Aligns a map with the true one: finds `truth_from_estimate` near `guess` (within about 0.5 m and 5 degrees) with the smallest distances
/// between occupied cells. By iterated closest points \[Besl92\], the reach of the pairs shrinking.
///
/// A map's own frame is arbitrary, so its offset is no error of the map; the remaining difference is.
///
/// # Errors
/// When a map has no occupied cell, none of them has a partner, or the guess is not finite.
pub fn align_maps(truth: &OccupancyGrid, estimate: &OccupancyGrid, guess: Pose2) -> Result<Pose2, EvalError> {
    if !guess.is_finite() {
        return Err(Invalid::new("guess", "not finite", "m, m, rad", "finite numbers").into());
    }
    let true_cells = OccupiedCells::of(truth);
    let points: Vec<Vector2> = OccupiedCells::of(estimate).centers().collect();
    if points.is_empty() {
        return Err(EvalError::NoObstacle { side: Side::Estimate });
    }
    let mut pose = guess;
    for round in 0..ALIGNMENT_ROUNDS {
        let shrunk = (round as f64 / (ALIGNMENT_ROUNDS as f64 * 0.7)).min(1.0);
        let reach = PAIRING_RADII_M.0 + (PAIRING_RADII_M.1 - PAIRING_RADII_M.0) * shrunk;
        let pair = |p: &Vector2| Some((*p, true_cells.nearest(pose.transform(*p), reach)?));
        let pairs: Vec<(Vector2, Vector2)> = points.iter().filter_map(pair).collect();
        if pairs.len() < 3 {
            return Err(EvalError::NoObstacle { side: Side::Reference });
        }
        pose = rigid(&pairs);
    }
    Ok(pose)
}

/// The pose that moves the firsts onto the seconds with the smallest square error \[Horn87\], in the plane.
fn rigid(pairs: &[(Vector2, Vector2)]) -> Pose2 {
    let count = pairs.len() as f64;
    let (from, to) = pairs.iter().fold((Vector2::zeros(), Vector2::zeros()), |(a, b), (p, q)| (a + p, b + q));
    let (from, to) = (from / count, to / count);
    let (dot, cross) = pairs.iter().fold((0.0, 0.0), |(dot, cross), (p, q)| {
        let (p, q) = (p - from, q - to);
        (dot + p.dot(&q), cross + p.perp(&q))
    });
    let turn = Pose2::new(0.0, 0.0, cross.atan2(dot));
    let shift = to - turn.rotate(from);
    Pose2::new(shift.x, shift.y, turn.theta)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Cell, GridGeometry};

    /// The walls of an L-shaped room, in the middles of cells of 5 cm, seen in a frame at `pose`.
    fn room(pose: Pose2) -> OccupancyGrid {
        let geometry = GridGeometry::new(0.05, Vector2::new(-8.0, -8.0), 320, 320).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        let corners = [(0.0, 0.0), (6.0, 0.0), (6.0, 2.0), (3.0, 2.0), (3.0, 5.0), (0.0, 5.0), (0.0, 0.0)];
        for pair in corners.windows(2) {
            let (a, b) = (Vector2::new(pair[0].0, pair[0].1), Vector2::new(pair[1].0, pair[1].1));
            for k in 0..1000 {
                let on_wall = a + (b - a) * (f64::from(k) / 1000.0) + Vector2::repeat(0.025);
                let p = pose.inverse().transform(on_wall);
                grid.set(geometry.cell_at(p).unwrap(), Cell::Occupied);
            }
        }
        grid
    }

    #[test]
    fn finds_where_a_map_lies_from_a_rough_guess() {
        let (truth, pose) = (room(Pose2::IDENTITY), Pose2::new(1.0, 0.5, 0.4));
        let found = align_maps(&truth, &room(pose), Pose2::new(1.3, 0.2, 0.45)).unwrap();
        let off = pose.inverse() * found;
        assert!(off.position().norm() < 0.02 && off.theta.abs() < 0.005, "{off:?}");
    }

    #[test]
    fn maps_without_a_common_place_are_refused() {
        let truth = room(Pose2::IDENTITY);
        assert!(align_maps(&truth, &truth, Pose2::new(500.0, 0.0, 0.0)).is_err());
        assert!(align_maps(&truth, &truth, Pose2 { x: f64::NAN, ..Pose2::IDENTITY }).is_err());
    }
}

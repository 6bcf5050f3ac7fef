//! The direction of walls by lines through their faces.

use super::surface::SurfaceCell;
use std::f64::consts::FRAC_PI_2;
use trundle_core::{Pose2, Vector2};

/// Distance across a wall from one cell to the next from which they belong to different walls \[cells\]. Source: ours.
const FACE_GAP_CELLS: f64 = 1.25;
/// Extent across a wall above which cells are no straight wall \[cells\]. Source: ours.
const MAX_FACE_DEPTH_CELLS: f64 = 3.0;
/// Smallest number of cells of a face. Source: ours.
const MIN_FACE_CELLS: usize = 15;
/// Largest angle between a wall at a cell and the axis \[rad\]. Source: ours, 15 deg.
const MAX_LEAN_RAD: f64 = 0.262;
/// Rounds of fitting and turning. Source: ours.
const FITTING_ROUNDS: usize = 4;

/// Sums over cells about their mean: along and across the walls.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    variance: f64,
    covariance: f64,
}

/// The turn near `turn` after which lines through the faces of walls are parallel to the axes, by least squares over all faces.
pub(super) fn fitted(cells: &[SurfaceCell], turn: f64) -> f64 {
    (0..FITTING_ROUNDS).fold(turn, |turn, _| {
        let (mut slope, mut weight) = (0.0, 0.0);
        for axis in 0..2 {
            let found = faces(cells, turn, axis);
            // A wall along x that rises needs a turn back, a wall along y that leans to the right a turn on.
            slope += if axis == 0 { -found.covariance } else { found.covariance };
            weight += found.variance;
        }
        if weight > 0.0 { turn + (slope / weight).atan() } else { turn }
    })
}

/// The moments of all faces along x (axis 0) or y (axis 1) after a turn.
fn faces(cells: &[SurfaceCell], turn: f64, axis: usize) -> Moments {
    let rotation = Pose2::new(0.0, 0.0, turn);
    let across = if axis == 0 { Vector2::new(0.0, 1.0) } else { Vector2::new(1.0, 0.0) };
    let mut total = Moments::default();
    for side in [1.0, -1.0] {
        let normal = rotation.inverse().rotate(across * side);
        let along = normal.y.atan2(normal.x) + FRAC_PI_2;
        let of_side =
            cells.iter().filter(|cell| cell.is_free_towards(normal) && cell.angle_to(along) < MAX_LEAN_RAD);
        // Across, along.
        let mut points: Vec<(f64, f64)> = of_side
            .map(|cell| rotation.rotate(cell.center))
            .map(|p| if axis == 0 { (p.y, p.x) } else { (p.x, p.y) })
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for face in points.chunk_by(|a, b| b.0 - a.0 < FACE_GAP_CELLS) {
            let depth = face[face.len() - 1].0 - face[0].0;
            if face.len() >= MIN_FACE_CELLS && depth <= MAX_FACE_DEPTH_CELLS {
                let found = moments(face);
                total.variance += found.variance;
                total.covariance += found.covariance;
            }
        }
    }
    total
}

fn moments(face: &[(f64, f64)]) -> Moments {
    let count = face.len() as f64;
    let (across, along) = face.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / count, sum.1 + p.1 / count));
    face.iter().fold(Moments::default(), |sum, p| Moments {
        variance: sum.variance + (p.1 - along).powi(2),
        covariance: sum.covariance + (p.1 - along) * (p.0 - across),
    })
}

//! Refinement of a pose between two maps.

use super::map_shape::MapShape;
use trundle_core::{Cell, Pose2, Vector2};

/// Maximum number of surface points. Source: ours.
const MAX_POINTS: usize = 1500;
/// Widths of the likelihood of a wall, one after the other \[cells\]. Source: ours.
const WIDTHS_CELLS: [f64; 3] = [4.0, 2.0, 1.0];
/// Last step of each search, as a part of the width. Source: ours.
const LAST_STEP_SHARE: f64 = 0.05;
/// Weight of a wall on free floor against one on a wall. Source: ours.
const CONTRADICTION_WEIGHT: f64 = 1.0;
/// Distance from a wall, in widths, from which a wall on free floor contradicts. Source: ours.
const CONTRADICTING_WIDTHS: f64 = 2.5;

/// Value from which a wall agrees. Source: ours.
const MIN_AGREEING_VALUE: f64 = 0.5;

/// The pose near `start` at which walls of the second map lie best on walls of the first one: a pattern search with ever smaller steps.
pub(super) fn refined(first: &MapShape, second: &MapShape, start: Pose2) -> Pose2 {
    let stride = second.surface.len().div_ceil(MAX_POINTS);
    let points: Vec<Vector2> = second.surface.iter().step_by(stride).copied().collect();
    let cell = first.resolution().max(second.resolution());
    WIDTHS_CELLS.iter().fold(start, |pose, width| {
        let width = width * cell;
        let (pivot, radius) =
            agreeing_part(first, &points, pose, width).unwrap_or((second.middle, second.radius.max(cell)));
        // The turn moves the map about the middle of what agrees: turn and shift are then independent.
        let about: Vec<Vector2> = points.iter().map(|p| p - pivot).collect();
        let at_pivot = pose * Pose2::new(pivot.x, pivot.y, 0.0);
        climbed(first, &about, at_pivot, width, radius) * Pose2::new(-pivot.x, -pivot.y, 0.0)
    })
}

/// Mean and root mean square radius of the points that agree at a pose.
fn agreeing_part(first: &MapShape, points: &[Vector2], pose: Pose2, width: f64) -> Option<(Vector2, f64)> {
    let agrees = |p: &&Vector2| value(first, pose.transform(**p), width) > MIN_AGREEING_VALUE;
    let agreeing: Vec<&Vector2> = points.iter().filter(agrees).collect();
    let count = agreeing.len() as f64;
    let mean = agreeing.iter().copied().sum::<Vector2>() / count.max(1.0);
    let square = agreeing.iter().map(|p| (*p - mean).norm_squared()).sum::<f64>() / count.max(1.0);
    (square.sqrt() > width).then(|| (mean, square.sqrt()))
}

fn climbed(first: &MapShape, points: &[Vector2], start: Pose2, width: f64, radius: f64) -> Pose2 {
    let score = |pose: Pose2| -> f64 { points.iter().map(|p| value(first, pose.transform(*p), width)).sum() };
    let (mut best, mut pose, mut step) = (score(start), start, width);
    while step > LAST_STEP_SHARE * width {
        let scored = neighbours(pose, step, step / radius).map(|pose| (score(pose), pose));
        let next = scored.into_iter().reduce(|best, next| if next.0 > best.0 { next } else { best });
        match next {
            Some((value, better)) if value > best => (best, pose) = (value, better),
            _ => step /= 2.0,
        }
    }
    pose
}

/// The poses a step or a turn away.
fn neighbours(pose: Pose2, step: f64, turn: f64) -> [Pose2; 6] {
    let moved = |x: f64, y: f64, turn: f64| Pose2::new(pose.x + x, pose.y + y, pose.theta + turn);
    [
        moved(step, 0.0, 0.0),
        moved(-step, 0.0, 0.0),
        moved(0.0, step, 0.0),
        moved(0.0, -step, 0.0),
        moved(0.0, 0.0, turn),
        moved(0.0, 0.0, -turn),
    ]
}

/// The value of a wall at a point of the first map: 1 on a wall, negative on free floor.
fn value(first: &MapShape, point: Vector2, width: f64) -> f64 {
    let Some(distance) = first.distance(point) else { return 0.0 };
    if distance > CONTRADICTING_WIDTHS * width {
        return if first.at(point) == Cell::Free { -CONTRADICTION_WEIGHT } else { 0.0 };
    }
    (-0.5 * (distance / width).powi(2)).exp()
}

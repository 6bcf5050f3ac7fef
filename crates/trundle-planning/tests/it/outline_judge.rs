//! A checker of trajectories of an outline that shares no code with the planner.

use crate::support::{HALF_BASE, LIMITS};
use trundle_core::{Cell, OccupancyGrid, Pose2, Vector2, difference_of_angles, wrap_angle};
use trundle_planning::PlanResult;

/// Whether the outline, half a millimetre smaller, meets an occupied square: points of the outline 5 mm apart, and the squares' corners.
/// This check shares no code with the planner.
pub fn touches(grid: &OccupancyGrid, outline: &[Vector2], pose: Pose2) -> bool {
    let at = |p: Vector2| {
        let (s, c) = pose.theta.sin_cos();
        Vector2::new(pose.x + c * p.x - s * p.y, pose.y + s * p.x + c * p.y)
    };
    let middle = outline.iter().sum::<Vector2>() / outline.len() as f64;
    let inner: Vec<Vector2> =
        outline.iter().map(|c| middle + (c - middle) * (1.0 - 1e-3 / (c - middle).norm())).collect();
    let occupied = |p: Vector2| grid.at(at(p)) == Cell::Occupied;
    let edges = || inner.iter().zip(inner.iter().cycle().skip(1));
    let crosses = edges().any(|(a, b)| {
        let steps = ((b - a).norm() / 0.005).ceil();
        (0..steps as usize).any(|k| occupied(a + (b - a) * (k as f64 / steps)))
    });
    let resolution = grid.geometry().resolution;
    let reach = outline.iter().map(|corner| corner.norm()).fold(0.0, f64::max);
    let cells = (reach / resolution).ceil() as i32 + 1;
    let corner_inside = || {
        (-cells..=cells).any(|i| {
            (-cells..=cells).any(|j| {
                let lattice = (pose.position() - grid.geometry().origin) / resolution;
                let corner = grid.geometry().origin
                    + Vector2::new(lattice.x.round() + f64::from(i), lattice.y.round() + f64::from(j))
                        * resolution;
                let (off, (s, c)) = (corner - pose.position(), pose.theta.sin_cos());
                let local = Vector2::new(c * off.x + s * off.y, c * off.y - s * off.x);
                let inside = edges().all(|(a, b)| (b - a).perp(&(local - a)) > 0.0);
                let around = [(0.1, 0.1), (-0.1, 0.1), (0.1, -0.1), (-0.1, -0.1)]
                    .map(|(x, y)| corner + Vector2::new(x, y) * resolution);
                inside && around.into_iter().any(|p| grid.at(p) == Cell::Occupied)
            })
        })
    };
    crosses || corner_inside()
}

/// Ends, limits, and no contact of a convex outline, each 2 mm and half a degree.
pub fn judge_outline(
    grid: &OccupancyGrid,
    outline: &[Vector2],
    result: &PlanResult,
    (start, goal): (Pose2, Pose2),
) {
    let points = result.trajectory.points();
    assert!(points[0].pose.distance(&start) < 1e-6 && result.trajectory.end().distance(&goal) < 1.1e-3);
    assert!(wrap_angle(result.trajectory.end().theta - goal.theta).abs() < 1e-5);
    for pair in points.windows(2) {
        let turn = difference_of_angles(pair[1].pose.theta, pair[0].pose.theta).abs();
        let steps = (pair[1].pose.distance(&pair[0].pose) / 0.002).max(turn / 0.01).ceil().max(1.0);
        for k in 0..steps as usize {
            let pose = pair[0].pose.interpolate(&pair[1].pose, k as f64 / steps);
            assert!(!touches(grid, outline, pose), "{pose:?}");
        }
        assert!(pair[1].twist.v + HALF_BASE * pair[1].twist.omega.abs() <= LIMITS.wheel_speed * 1.01);
    }
}

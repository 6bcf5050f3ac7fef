//! Moving obstacles: their forecast over two seconds, and encounters with a trajectory.

use trundle_collision::Segment;
use trundle_core::{
    Cell, Invalid, OccupancyGrid, Trajectory, TrajectoryPoint, Twist2, Vector2, require_finite,
};

/// Horizon of the constant-velocity forecast, s. Later motion is unknown. Source: ours.
pub(crate) const FORECAST_HORIZON_S: f64 = 2.0;
/// Time for which a stopped person may continue to walk, s. A longer stop counts as static. Source: ours.
pub(crate) const MAX_PAUSE_S: f64 = 10.0;
/// Extra clearance of a new plan from moving obstacles, m: small differences of velocity in the next scan must not invalidate the plan.
/// Source: ours.
const NEW_PLAN_MARGIN_M: f64 = 0.05;
/// Time between two checks for an encounter, s. Source: ours.
const CHECK_PERIOD_S: f64 = 0.02;
/// Step of the waits that are tried, s. Source: ours.
const WAIT_STEP_S: f64 = 0.1;

/// A disc with constant velocity: a person, another robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingObstacle {
    position: Vector2,
    velocity: Vector2,
    radius: f64,
}

impl MovingObstacle {
    /// A disc of `radius` m about `position` (map frame, m) that moves with `velocity` (m/s).
    ///
    /// # Errors
    /// When a number is not finite, or the radius is negative.
    pub fn new(position: Vector2, velocity: Vector2, radius: f64) -> Result<Self, Invalid> {
        let numbers = [("x", position.x), ("y", position.y), ("vx", velocity.x), ("vy", velocity.y)];
        for (name, value) in numbers {
            require_finite(&format!("obstacle {name}"), value, "m, m/s")?;
        }
        trundle_core::require_in("obstacle radius", radius, "m", 0.0, 100.0)?;
        Ok(Self { position, velocity, radius })
    }

    /// The same obstacle with the margin of new plans.
    pub(crate) fn with_margin(self) -> Self {
        Self { radius: self.radius + NEW_PLAN_MARGIN_M, ..self }
    }

    /// Whether its velocity is zero.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.velocity == Vector2::zeros()
    }

    /// Radius of the disc, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Centre after `time` s, map frame, m.
    pub fn at(&self, time: f64) -> Vector2 {
        self.position + self.velocity * time
    }
}

/// Time of the first encounter, s from now. A disc of `radius` m follows the trajectory, from `from` s on, and overlaps an obstacle within
/// the forecast horizon. An obstacle that overlaps at the start counts only while it approaches.
pub(crate) fn first_encounter_of(
    trajectory: &Trajectory,
    from: f64,
    obstacles: &[MovingObstacle],
    radius: f64,
) -> Option<f64> {
    let gap = |obstacle: &MovingObstacle, time: f64| {
        (trajectory.at(from + time).pose.position() - obstacle.at(time)).norm() - obstacle.radius - radius
    };
    let steps = (FORECAST_HORIZON_S / CHECK_PERIOD_S) as usize;
    (0..=steps).map(|k| k as f64 * CHECK_PERIOD_S).find(|time| {
        obstacles.iter().any(|obstacle| {
            let now = gap(obstacle, *time);
            now < 0.0 && (gap(obstacle, 0.0) >= 0.0 || now < gap(obstacle, 0.0) - 1e-3)
        })
    })
}

/// Half the time around an encounter during which an obstacle's path is closed, s. Source: ours.
const CLOSED_HALF_TIME_S: f64 = 0.4;

/// Occupies the cells that the obstacles pass around `time`, within the horizon.
pub(crate) fn close_cells(closed: &mut OccupancyGrid, obstacles: &[MovingObstacle], time: f64) {
    let geometry = *closed.geometry();
    for obstacle in obstacles {
        let (a, b) = (
            obstacle.at((time - CLOSED_HALF_TIME_S).max(0.0)),
            obstacle.at((time + CLOSED_HALF_TIME_S).min(FORECAST_HORIZON_S)),
        );
        let wide = Vector2::repeat(obstacle.radius + geometry.resolution);
        let index =
            |at: f64, size: usize| (at / geometry.resolution).floor().clamp(0.0, size as f64 - 1.0) as usize;
        let (low, high) = (a.inf(&b) - wide - geometry.origin, a.sup(&b) + wide - geometry.origin);
        for row in index(low.y, geometry.height)..=index(high.y, geometry.height) {
            for col in index(low.x, geometry.width)..=index(high.x, geometry.width) {
                let cell = trundle_core::CellIndex { col, row };
                let centre = geometry.center(cell);
                let off = (centre - Segment { a, b }.nearest(centre)).norm();
                if off < obstacle.radius + geometry.resolution * std::f64::consts::FRAC_1_SQRT_2 {
                    closed.set(cell, Cell::Occupied);
                }
            }
        }
    }
}

/// The trajectory from rest, started as late as needed to meet no obstacle within the horizon; and the delay, s.
pub(crate) fn delayed(
    trajectory: &Trajectory,
    obstacles: &[MovingObstacle],
    radius: f64,
) -> Option<(Trajectory, f64)> {
    paused(trajectory, 0.0, obstacles, radius)
}

/// The trajectory with the shortest wait at `stop` s that then meets no obstacle within the horizon, and the wait, s. The trajectory is at
/// rest at `stop`.
pub(crate) fn paused(
    trajectory: &Trajectory,
    stop: f64,
    obstacles: &[MovingObstacle],
    radius: f64,
) -> Option<(Trajectory, f64)> {
    let waits = (0..=(FORECAST_HORIZON_S / WAIT_STEP_S) as usize).map(|k| k as f64 * WAIT_STEP_S);
    waits
        .map(|wait| (with_pause(trajectory, stop, wait), wait))
        .find(|(late, _)| first_encounter_of(late, 0.0, obstacles, radius).is_none())
}

/// The trajectory with a wait of `wait` s at its sample at `stop` s.
fn with_pause(trajectory: &Trajectory, stop: f64, wait: f64) -> Trajectory {
    let points = trajectory.points();
    let at = points.partition_point(|point| point.time < stop).min(points.len() - 1);
    let still = TrajectoryPoint { twist: Twist2::ZERO, ..points[at] };
    let steps = (wait / CHECK_PERIOD_S).round() as usize;
    let stand = |k: usize| TrajectoryPoint { time: still.time + k as f64 * wait / steps as f64, ..still };
    let late = points[at..].iter().map(|p| TrajectoryPoint { time: p.time + wait, ..*p });
    let all = points[..at].iter().copied().chain((0..steps).map(stand)).chain(late);
    Trajectory::new(all.collect()).expect("invariant: times still rise")
}

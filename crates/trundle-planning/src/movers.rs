//! Things that move: where they will be within two seconds, and what that means for a trajectory.

use trundle_core::{
    Cell, Invalid, OccupancyGrid, Trajectory, TrajectoryPoint, Twist2, Vector2, require_finite,
};

/// How far ahead a steady motion is believed, s.
pub(crate) const HORIZON: f64 = 2.0;
/// Who walked and stopped is believed to go on any moment for so long, s.
pub(crate) const MAY_GO_ON: f64 = 10.0;
/// Plans keep so much more from movers than is asked of one that is under way, m: the next scan's velocities are a little
/// different, and must not overturn a plan that was just made.
const MARGIN: f64 = 0.05;
/// Time between two looks, s.
const LOOK: f64 = 0.02;
/// Longest waits are tried in steps of this, s.
const WAIT: f64 = 0.1;

/// A disc that moves steadily: a person, another robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mover {
    position: Vector2,
    velocity: Vector2,
    radius: f64,
}

impl Mover {
    /// A disc of `radius` m about `position` (map frame, m) that moves with `velocity` (m/s).
    ///
    /// # Errors
    /// When a number is not finite, or the radius is negative.
    pub fn new(position: Vector2, velocity: Vector2, radius: f64) -> Result<Self, Invalid> {
        let numbers = [("x", position.x), ("y", position.y), ("vx", velocity.x), ("vy", velocity.y)];
        for (name, value) in numbers {
            require_finite(&format!("mover {name}"), value, "m, m/s")?;
        }
        trundle_core::require_in("mover radius", radius, "m", 0.0, 100.0)?;
        Ok(Self { position, velocity, radius })
    }

    /// The same, and room to spare.
    pub(crate) fn with_margin(self) -> Self {
        Self { radius: self.radius + MARGIN, ..self }
    }

    /// Whether it is where it is for now.
    pub(crate) fn stands(&self) -> bool {
        self.velocity == Vector2::zeros()
    }

    /// Of its disc, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Where its centre will be after `time` s, map frame, m.
    pub fn at(&self, time: f64) -> Vector2 {
        self.position + self.velocity * time
    }
}

/// When a disc of `radius` m that follows the trajectory, `from` seconds into it now, first comes nearer to a mover than both
/// allow, within the horizon, s from now. A mover that is too near already counts only while it comes nearer.
pub(crate) fn conflict(trajectory: &Trajectory, from: f64, movers: &[Mover], radius: f64) -> Option<f64> {
    let gap = |mover: &Mover, time: f64| {
        (trajectory.at(from + time).pose.position() - mover.at(time)).norm() - mover.radius - radius
    };
    let steps = (HORIZON / LOOK) as usize;
    (0..=steps).map(|k| k as f64 * LOOK).find(|time| {
        movers.iter().any(|mover| {
            let now = gap(mover, *time);
            now < 0.0 && (gap(mover, 0.0) >= 0.0 || now < gap(mover, 0.0) - 1e-3)
        })
    })
}

/// Half the time about an encounter during which a mover's place is closed, s.
const CLOSED: f64 = 0.4;

/// Occupies the places that the movers come through about `time`, within the horizon.
pub(crate) fn stamp(stamped: &mut OccupancyGrid, movers: &[Mover], time: f64) {
    let geometry = *stamped.geometry();
    for mover in movers {
        let (a, b) = (mover.at((time - CLOSED).max(0.0)), mover.at((time + CLOSED).min(HORIZON)));
        let wide = Vector2::repeat(mover.radius + geometry.resolution);
        let index =
            |at: f64, size: usize| (at / geometry.resolution).floor().clamp(0.0, size as f64 - 1.0) as usize;
        let (low, high) = (a.inf(&b) - wide - geometry.origin, a.sup(&b) + wide - geometry.origin);
        for row in index(low.y, geometry.height)..=index(high.y, geometry.height) {
            for col in index(low.x, geometry.width)..=index(high.x, geometry.width) {
                let cell = trundle_core::CellIndex { col, row };
                let centre = geometry.center(cell);
                let off = (centre - crate::geometry::nearest_on_segment(centre, a, b)).norm();
                if off < mover.radius + geometry.resolution * std::f64::consts::FRAC_1_SQRT_2 {
                    stamped.set(cell, Cell::Occupied);
                }
            }
        }
    }
}

/// The trajectory from rest, begun as late as it takes to meet no mover within the horizon, and by how much later, s.
pub(crate) fn delayed(trajectory: &Trajectory, movers: &[Mover], radius: f64) -> Option<(Trajectory, f64)> {
    paused(trajectory, 0.0, movers, radius)
}

/// The trajectory with the shortest wait at `stop` s, where it is at rest, after which it meets no mover within the horizon;
/// and the wait, s.
pub(crate) fn paused(
    trajectory: &Trajectory,
    stop: f64,
    movers: &[Mover],
    radius: f64,
) -> Option<(Trajectory, f64)> {
    let waits = (0..=(HORIZON / WAIT) as usize).map(|k| k as f64 * WAIT);
    waits
        .map(|wait| (with_pause(trajectory, stop, wait), wait))
        .find(|(late, _)| conflict(late, 0.0, movers, radius).is_none())
}

/// The trajectory, standing for `wait` s from its sample at `stop` s on.
fn with_pause(trajectory: &Trajectory, stop: f64, wait: f64) -> Trajectory {
    let points = trajectory.points();
    let at = points.partition_point(|point| point.time < stop).min(points.len() - 1);
    let still = TrajectoryPoint { twist: Twist2::ZERO, ..points[at] };
    let steps = (wait / LOOK).round() as usize;
    let stand = |k: usize| TrajectoryPoint { time: still.time + k as f64 * wait / steps as f64, ..still };
    let late = points[at..].iter().map(|p| TrajectoryPoint { time: p.time + wait, ..*p });
    let all = points[..at].iter().copied().chain((0..steps).map(stand)).chain(late);
    Trajectory::new(all.collect()).expect("invariant: times still rise")
}

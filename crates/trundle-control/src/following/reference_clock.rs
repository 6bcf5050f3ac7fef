//! The clock of the reference, which waits for the robot.

use crate::following::follower_config::FollowerConfig;
use crate::path_tracking::tracking_error::TrackingError;
use trundle_core::{Pose2, Trajectory, TrajectoryPoint, Twist2};

/// A trajectory with its own clock.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ReferenceClock {
    trajectory: Trajectory,
    time: f64,
    rate: f64,
    arrival_time: f64,
}

/// Distance to the end position within which the trajectory has arrived, m. Larger: point stabilisation begins earlier. Source: ours.
const ARRIVAL_DISTANCE_M: f64 = 1e-3;

impl ReferenceClock {
    pub(super) fn new(trajectory: Trajectory) -> Self {
        let arrival_time = arrival_time(&trajectory);
        Self { trajectory, time: 0.0, rate: 1.0, arrival_time }
    }

    /// Advances the reference by `dt` seconds, or by less if the robot is behind the reference.
    pub(super) fn advance(&mut self, dt: f64, pose: Pose2, config: &FollowerConfig) {
        let error = TrackingError::between(pose, self.trajectory.at(self.time).pose);
        self.rate = clock_rate(error, self.trajectory.at(self.time).twist, config);
        self.time = (self.time + self.rate * dt).min(self.trajectory.duration());
    }

    /// Seconds of the trajectory that have passed.
    pub(super) fn time(&self) -> f64 {
        self.time
    }

    /// The last pose of the trajectory.
    pub(super) fn end(&self) -> Pose2 {
        self.trajectory.end()
    }

    /// The pose the robot should have now; its twist is scaled by the clock's rate.
    pub(super) fn reference(&self) -> TrajectoryPoint {
        let point = self.trajectory.at(self.time);
        TrajectoryPoint { twist: scaled(point.twist, self.rate), ..point }
    }

    /// The reference for the tracking law: the present pose with the twist `lead` s later, at which the command takes effect.
    pub(super) fn reference_ahead(&self, lead: f64) -> TrajectoryPoint {
        let point = self.trajectory.at(self.time);
        let then = self.trajectory.at(self.time + lead * self.rate);
        TrajectoryPoint { twist: scaled(then.twist, self.rate), ..point }
    }

    /// Whether the rest of the trajectory is at most a turn on the spot.
    pub(super) fn has_arrived(&self) -> bool {
        self.time >= self.arrival_time
    }
}

fn scaled(twist: Twist2, factor: f64) -> Twist2 {
    Twist2::new(twist.v * factor, twist.omega * factor)
}

/// The time from which the position is constant, s.
fn arrival_time(trajectory: &Trajectory) -> f64 {
    let end = trajectory.end();
    let points = trajectory.points();
    let away = points.iter().rposition(|point| point.pose.distance(&end) > ARRIVAL_DISTANCE_M);
    away.map_or(0.0, |i| points[i + 1].time)
}

/// Rate of the reference clock, 0 to 1.
///
/// The clock may stop for errors that A6 regulates at rest: along the path, and in heading. A lateral error only slows the clock.
fn clock_rate(error: TrackingError, reference: Twist2, config: &FollowerConfig) -> f64 {
    let remaining = |error: f64, from: f64, to: f64| ((to - error) / (to - from)).clamp(0.0, 1.0);
    let behind = if reference.v < 0.0 { -error.along } else { error.along };
    let along = remaining(behind, config.wait_from, config.wait_at);
    let cross = remaining(error.cross.abs(), config.wait_from, config.wait_at).max(config.min_rate);
    let heading = remaining(error.heading.abs(), 0.5 * config.wait_heading, config.wait_heading);
    along.min(cross).min(heading)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn straight_and_turn() -> Trajectory {
        let at = |time, x, theta, v, omega| TrajectoryPoint {
            time,
            pose: Pose2::new(x, 0.0, theta),
            twist: Twist2::new(v, omega),
        };
        let points = vec![
            at(0.0, 0.0, 0.0, 0.5, 0.0),
            at(2.0, 1.0, 0.0, 0.5, 0.0),
            at(2.1, 1.0, 0.0, 0.0, 1.0),
            at(3.1, 1.0, 1.0, 0.0, 1.0),
        ];
        Trajectory::new(points).unwrap()
    }

    #[test]
    fn the_clock_stops_for_a_robot_at_rest() {
        let mut clock = ReferenceClock::new(straight_and_turn());
        let config = FollowerConfig::default();
        for _ in 0..1000 {
            clock.advance(0.02, Pose2::IDENTITY, &config);
        }
        let reference = clock.reference();
        assert!(reference.pose.x > 0.05 && reference.pose.x < config.wait_at, "{reference:?}");
        assert!(reference.twist.v < 0.01, "the reference's twist goes with its clock");
    }

    #[test]
    fn an_error_beside_the_path_only_slows_the_clock() {
        let mut clock = ReferenceClock::new(straight_and_turn());
        clock.advance(1.0, Pose2::new(0.0, 0.5, 0.0), &FollowerConfig::default());
        assert!((clock.time() - 0.4).abs() < 1e-12);
    }

    #[test]
    fn the_trajectory_arrives_where_only_a_turn_is_left() {
        let mut clock = ReferenceClock::new(straight_and_turn());
        let config = FollowerConfig::default();
        clock.advance(1.9, Pose2::IDENTITY, &config);
        assert!(!clock.has_arrived());
        clock.advance(0.1, Pose2::new(1.0, 0.0, 0.0), &config);
        assert!(clock.has_arrived());
    }
}

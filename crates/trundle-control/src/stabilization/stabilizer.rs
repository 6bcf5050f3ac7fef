//! Point stabilisation with its phases: approach, turn, rest.

use crate::limiter::Limiter;
use crate::path_tracking::tracking_error::TrackingError;
use crate::stabilization::polar_law::{Gear, Polar, polar_law, select_gear};
use crate::stabilization::stabilizer_config::StabilizerConfig;
use std::f64::consts::TAU;
use trundle_core::{DifferentialDrive, DriveLimits, Invalid, Pose2, PoseEstimate, Twist2};

/// Drives the base to a near pose and brings it to rest there.
#[derive(Debug, Clone, PartialEq)]
pub struct Stabilizer {
    config: StabilizerConfig,
    pub(super) limiter: Limiter,
    phase: StabilizerPhase,
    gear: Option<Gear>,
    goal: Option<Pose2>,
    /// Number of retries for this goal.
    retries: u32,
    /// Angle turned in this approach, counter-clockwise, rad.
    turned_angle: f64,
}

/// Phase of point stabilisation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StabilizerPhase {
    /// Drives to the position.
    Approaching,
    /// Turns on the spot to the heading.
    Turning,
    /// The robot is at rest within the tolerances.
    Settled,
}

/// Result of one control step of point stabilisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StabilizerReport {
    /// The twist to send.
    pub twist: Twist2,
    /// The phase.
    pub phase: StabilizerPhase,
    /// The goal in the robot's frame.
    pub error: TrackingError,
    /// Whether a limit of the base changed the law's command.
    pub saturated: bool,
}

/// Part of the position tolerance at which the turn begins. Larger: less accurate, fewer retries. Source: ours.
const POSITION_TOLERANCE_PART: f64 = 0.4;
/// Part of the heading tolerance at which the turn ends. Larger: less accurate, fewer retries. Source: ours.
const HEADING_TOLERANCE_PART: f64 = 0.5;
/// Turn rate below which the base counts as at rest, rad/s. A larger value reports the rest earlier, with more overshoot. Source: ours.
const STANDSTILL_RATE_RAD_PER_S: f64 = 0.03;
/// Largest shift of a goal that counts as the same goal, m and rad. With a larger value, fewer map corrections restart the approach.
/// Source: ours.
const SAME_GOAL_M_AND_RAD: f64 = 0.05;

impl Stabilizer {
    /// A stabilizer for a base at rest.
    ///
    /// # Errors
    /// When a number of the configuration, the drive or the limits is outside its range.
    pub fn new(
        config: StabilizerConfig,
        drive: DifferentialDrive,
        limits: DriveLimits,
    ) -> Result<Self, Invalid> {
        Ok(Self {
            config: config.validated()?,
            limiter: Limiter::new(drive, limits)?,
            phase: StabilizerPhase::Approaching,
            gear: None,
            goal: None,
            retries: 0,
            turned_angle: 0.0,
        })
    }

    /// Sets the twist that was really sent, if it differs from the last one reported.
    pub fn sent(&mut self, twist: Twist2) {
        self.limiter.sent(twist);
    }

    /// Drops the approach so far: the next step restarts it, even for the same goal.
    pub fn restart(&mut self) {
        self.goal = None;
    }

    /// The command for now, `dt` seconds after the last one; `goal` in the frame of the estimate.
    pub fn step(&mut self, estimate: &PoseEstimate, goal: Pose2, dt: f64) -> StabilizerReport {
        self.accept_goal(goal);
        self.turned_angle += estimate.twist.omega * dt;
        let error = TrackingError::between(estimate.pose, goal);
        self.update_phase(error, estimate.twist);
        let wanted = match self.phase {
            StabilizerPhase::Approaching => self.approach_twist(estimate.pose, goal),
            StabilizerPhase::Turning => Twist2::new(0.0, self.turn_rate_towards(error.heading)),
            StabilizerPhase::Settled => Twist2::ZERO,
        };
        let limited = self.limiter.limit(wanted, dt);
        StabilizerReport { twist: limited.twist, phase: self.phase, error, saturated: limited.saturated }
    }

    /// A new goal restarts the approach; a goal that a map correction moved a little does not.
    fn accept_goal(&mut self, goal: Pose2) {
        let same = self.goal.is_some_and(|last| {
            let moved = TrackingError::between(last, goal);
            moved.distance() < SAME_GOAL_M_AND_RAD && moved.heading.abs() < SAME_GOAL_M_AND_RAD
        });
        if !same {
            self.restart_approach();
            self.retries = 0;
            self.goal = Some(goal);
        }
    }

    fn update_phase(&mut self, error: TrackingError, moving: Twist2) {
        let distance = error.distance() / self.config.position_tolerance;
        let heading = error.heading.abs() / self.config.heading_tolerance;
        let patient = self.retries < self.config.attempts;
        let enough = if patient { 1.0 } else { self.config.release };
        let standing = moving.omega.abs() < STANDSTILL_RATE_RAD_PER_S
            && self.limiter.last().omega.abs() < STANDSTILL_RATE_RAD_PER_S;
        match self.phase {
            StabilizerPhase::Approaching if distance <= enough * POSITION_TOLERANCE_PART => {
                self.phase = StabilizerPhase::Turning
            }
            StabilizerPhase::Approaching if self.turned_angle.abs() > TAU => self.stop_circling(),
            StabilizerPhase::Turning if distance > enough && patient => self.retry(),
            StabilizerPhase::Turning if heading <= HEADING_TOLERANCE_PART && standing => {
                self.phase = StabilizerPhase::Settled
            }
            StabilizerPhase::Settled if distance > self.config.release && patient => self.retry(),
            StabilizerPhase::Settled if heading > self.config.release => {
                self.phase = StabilizerPhase::Turning
            }
            _ => {}
        }
    }

    fn retry(&mut self) {
        self.retries += 1;
        self.restart_approach();
    }

    fn restart_approach(&mut self) {
        (self.gear, self.turned_angle) = (None, 0.0);
        self.phase = StabilizerPhase::Approaching;
    }

    /// Ends an approach whose total turn reaches a full turn. Cause: an error of the map moves the estimate around the goal during a turn,
    /// and the robot would circle without end. The stabilizer then accepts `release` tolerances, and after that the present position.
    fn stop_circling(&mut self) {
        if self.retries < self.config.attempts {
            self.retries = self.config.attempts;
            self.restart_approach();
        } else {
            self.phase = StabilizerPhase::Turning;
        }
    }

    fn approach_twist(&mut self, pose: Pose2, goal: Pose2) -> Twist2 {
        let gear = select_gear(goal, pose, self.gear);
        self.gear = Some(gear);
        polar_law(Polar::about(goal, pose, gear), gear, &self.config)
    }

    /// Turn rate towards the goal heading, rad/s: proportional to the error, limited by what half the angular acceleration can brake.
    fn turn_rate_towards(&self, heading: f64) -> f64 {
        let braking = (self.limiter.limits().angular_acceleration * heading.abs()).sqrt();
        let rate = (self.config.k_turn * heading.abs()).min(braking).min(self.config.turn_rate);
        rate.copysign(heading)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Stamp;

    /// End pose, turns and phase of a robot on its goal whose estimate is always `offset` m to its right.
    fn end_with_offset_estimate(offset: f64) -> (Pose2, f64, StabilizerPhase) {
        let drive = DifferentialDrive::KOBUKI;
        let mut law = Stabilizer::new(StabilizerConfig::default(), drive, DriveLimits::KOBUKI).unwrap();
        let (goal, dt) = (Pose2::new(1.0, 2.0, -1.5), 0.02);
        let (mut pose, mut twist, mut turned) = (Pose2::new(1.0, 2.0, 0.4), Twist2::ZERO, 0.0);
        for _ in 0..1500 {
            let estimated = pose * Pose2::new(0.0, -offset, 0.0);
            let covariance = nalgebra::Matrix3::zeros();
            let estimate = PoseEstimate { stamp: Stamp::default(), pose: estimated, twist, covariance };
            let report = law.step(&estimate, goal, dt);
            if report.phase == StabilizerPhase::Settled {
                break;
            }
            twist = report.twist;
            turned += twist.omega.abs() * dt / TAU;
            pose = pose.advance(twist, dt);
        }
        (pose, turned, law.phase)
    }

    #[test]
    fn an_estimate_that_moves_with_the_heading_causes_no_endless_turn() {
        for offset in [0.008, 0.015, 0.03] {
            let (pose, turned, state) = end_with_offset_estimate(offset);
            assert_eq!(state, StabilizerPhase::Settled, "offset {offset} m, {turned} turns");
            assert!(turned < 3.5 && pose.distance(&Pose2::new(1.0, 2.0, 0.0)) < 0.05, "{turned}, {pose:?}");
        }
        assert!(end_with_offset_estimate(0.0).1 < 0.4, "without an offset one turn is enough");
    }
}

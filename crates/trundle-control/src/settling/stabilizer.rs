use super::SettleConfig;
use super::polar::{Gear, Polar, gear, polar_law};
use crate::{Limiter, TrackingError};
use std::f64::consts::TAU;
use trundle_core::{DifferentialDrive, DriveLimits, Invalid, Pose2, PoseEstimate, Twist2};

/// Brings the base to a pose near by, and to rest there.
#[derive(Debug, Clone, PartialEq)]
pub struct Stabilizer {
    config: SettleConfig,
    pub(super) limiter: Limiter,
    state: SettleState,
    gear: Option<Gear>,
    goal: Option<Pose2>,
    /// How often it had to go again.
    repeats: u32,
    /// How far it has turned in this approach, counter-clockwise, rad.
    turned: f64,
}

/// What the robot does about its goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SettleState {
    /// Drives to the position.
    Approaching,
    /// Turns on the spot to the heading.
    Turning,
    /// Stands within the tolerances.
    Settled,
}

/// One step of settling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SettleReport {
    /// The twist to send.
    pub twist: Twist2,
    /// What it is for.
    pub state: SettleState,
    /// Where the goal is, seen from the robot.
    pub error: TrackingError,
    /// Whether a limit of the base changed what the law wanted.
    pub saturated: bool,
}

/// The robot goes for this part of the position tolerance.
const ARRIVED: f64 = 0.4;
/// And for this part of the heading tolerance.
const TURNED: f64 = 0.5;
/// A base that turns slower than this stands, rad/s.
const STANDING: f64 = 0.03;
/// A goal that moved by less is the same goal, m and rad.
const SAME_GOAL: f64 = 0.05;

impl Stabilizer {
    /// A stabilizer for a base at rest.
    ///
    /// # Errors
    /// When a number of the configuration, the drive or the limits is outside its range.
    pub fn new(config: SettleConfig, drive: DifferentialDrive, limits: DriveLimits) -> Result<Self, Invalid> {
        Ok(Self {
            config: config.validated()?,
            limiter: Limiter::new(drive, limits)?,
            state: SettleState::Approaching,
            gear: None,
            goal: None,
            repeats: 0,
            turned: 0.0,
        })
    }

    /// Says what the base was really asked for, where that is not the last twist reported.
    pub fn sent(&mut self, twist: Twist2) {
        self.limiter.sent(twist);
    }

    /// Forgets what was tried so far: the next step begins anew, even for the same goal.
    pub fn restart(&mut self) {
        self.goal = None;
    }

    /// The command for now, `dt` seconds after the last one; `goal` in the frame of the estimate.
    pub fn step(&mut self, estimate: &PoseEstimate, goal: Pose2, dt: f64) -> SettleReport {
        self.take_goal(goal);
        self.turned += estimate.twist.omega * dt;
        let error = TrackingError::between(estimate.pose, goal);
        self.change_state(error, estimate.twist);
        let wanted = match self.state {
            SettleState::Approaching => self.approach(estimate.pose, goal),
            SettleState::Turning => Twist2::new(0.0, self.turn(error.heading)),
            SettleState::Settled => Twist2::ZERO,
        };
        let limited = self.limiter.limit(wanted, dt);
        SettleReport { twist: limited.twist, state: self.state, error, saturated: limited.saturated }
    }

    /// Another goal is another beginning; one that a map correction moved a little is not.
    fn take_goal(&mut self, goal: Pose2) {
        let same = self.goal.is_some_and(|last| {
            let moved = TrackingError::between(last, goal);
            moved.distance() < SAME_GOAL && moved.heading.abs() < SAME_GOAL
        });
        if !same {
            self.approach_anew();
            self.repeats = 0;
            self.goal = Some(goal);
        }
    }

    fn change_state(&mut self, error: TrackingError, moving: Twist2) {
        let distance = error.distance() / self.config.position_tolerance;
        let heading = error.heading.abs() / self.config.heading_tolerance;
        let patient = self.repeats < self.config.attempts;
        let enough = if patient { 1.0 } else { self.config.release };
        let standing = moving.omega.abs() < STANDING && self.limiter.last().omega.abs() < STANDING;
        match self.state {
            SettleState::Approaching if distance <= enough * ARRIVED => self.state = SettleState::Turning,
            SettleState::Approaching if self.turned.abs() > TAU => self.stop_circling(),
            SettleState::Turning if distance > enough && patient => self.go_again(),
            SettleState::Turning if heading <= TURNED && standing => self.state = SettleState::Settled,
            SettleState::Settled if distance > self.config.release && patient => self.go_again(),
            SettleState::Settled if heading > self.config.release => self.state = SettleState::Turning,
            _ => {}
        }
    }

    fn go_again(&mut self) {
        self.repeats += 1;
        self.approach_anew();
    }

    fn approach_anew(&mut self) {
        (self.gear, self.turned) = (None, 0.0);
        self.state = SettleState::Approaching;
    }

    /// No approach takes a whole turn, unless the estimate goes round the goal as the robot turns, by a map that is off by a centimetre
    /// to this side and that: it would turn after the goal for ever. It makes do with `release` tolerances, else with where it is.
    fn stop_circling(&mut self) {
        if self.repeats < self.config.attempts {
            self.repeats = self.config.attempts;
            self.approach_anew();
        } else {
            self.state = SettleState::Turning;
        }
    }

    fn approach(&mut self, pose: Pose2, goal: Pose2) -> Twist2 {
        let gear = gear(goal, pose, self.gear);
        self.gear = Some(gear);
        polar_law(Polar::about(goal, pose, gear), gear, &self.config)
    }

    /// Proportional near the heading; further off no faster than half the angular acceleration can brake.
    fn turn(&self, heading: f64) -> f64 {
        let braking = (self.limiter.limits().angular_acceleration * heading.abs()).sqrt();
        let rate = (self.config.k_turn * heading.abs()).min(braking).min(self.config.turn_rate);
        rate.copysign(heading)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Stamp;

    /// Where a robot ends that stands on its goal and is told that it stands `aside` m to the right of that, whichever way it turns; how
    /// often it turned round, and whether it has settled.
    fn told_aside(aside: f64) -> (Pose2, f64, SettleState) {
        let drive = DifferentialDrive::KOBUKI;
        let mut law = Stabilizer::new(SettleConfig::default(), drive, DriveLimits::KOBUKI).unwrap();
        let (goal, dt) = (Pose2::new(1.0, 2.0, -1.5), 0.02);
        let (mut pose, mut twist, mut turned) = (Pose2::new(1.0, 2.0, 0.4), Twist2::ZERO, 0.0);
        for _ in 0..1500 {
            let told = pose * Pose2::new(0.0, -aside, 0.0);
            let covariance = nalgebra::Matrix3::zeros();
            let estimate = PoseEstimate { stamp: Stamp::default(), pose: told, twist, covariance };
            let report = law.step(&estimate, goal, dt);
            if report.state == SettleState::Settled {
                break;
            }
            twist = report.twist;
            turned += twist.omega.abs() * dt / TAU;
            pose = pose.advance(twist, dt);
        }
        (pose, turned, law.state)
    }

    #[test]
    fn it_does_not_turn_after_the_goal_for_ever() {
        for aside in [0.008, 0.015, 0.03] {
            let (pose, turned, state) = told_aside(aside);
            assert_eq!(state, SettleState::Settled, "told {aside} m aside, turned {turned} times");
            assert!(turned < 3.5 && pose.distance(&Pose2::new(1.0, 2.0, 0.0)) < 0.05, "{turned}, {pose:?}");
        }
        assert!(told_aside(0.0).1 < 0.4, "a goal that is there is turned to");
    }
}

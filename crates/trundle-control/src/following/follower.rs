//! The follower: one step from an estimate to a twist.

use crate::following::follower_config::FollowerConfig;
use crate::following::reference_clock::ReferenceClock;
use crate::limiter::Limiter;
use crate::path_tracking::path_tracker::PathTracker;
use crate::path_tracking::tracking_error::TrackingError;
use crate::stabilization::stabilizer::{Stabilizer, StabilizerPhase};
use crate::stabilization::stabilizer_preview::StabilizerPreview;
use std::fmt;
use trundle_core::{
    DifferentialDrive, DriveLimits, Invalid, Pose2, PoseEstimate, Stamp, Trajectory, TrajectoryPoint, Twist2,
};

/// Follows a trajectory and comes to rest at its goal.
#[derive(Debug, Clone, PartialEq)]
pub struct Follower {
    config: FollowerConfig,
    tracker: PathTracker,
    stabilizer: Stabilizer,
    limiter: Limiter,
    task: Option<FollowTask>,
    last_step: Option<Stamp>,
}

#[derive(Debug, Clone, PartialEq)]
struct FollowTask {
    clock: ReferenceClock,
    goal: Pose2,
    settling: bool,
}

/// Phase of following.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FollowPhase {
    /// No trajectory: the robot brakes and remains at rest.
    Idle,
    /// The robot tracks the trajectory.
    Tracking,
    /// The robot is near the goal and approaches its position.
    Approaching,
    /// The robot is on the goal's position and turns to its heading.
    Turning,
    /// The robot is at the goal, at rest.
    Settled,
}

impl fmt::Display for FollowPhase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Idle => "idle",
            Self::Tracking => "tracking",
            Self::Approaching => "approaching",
            Self::Turning => "turning",
            Self::Settled => "settled",
        })
    }
}

/// Result of one control step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowReport {
    /// The twist to send.
    pub twist: Twist2,
    /// The phase.
    pub phase: FollowPhase,
    /// Reference pose and twist of the robot; after the arrival, the goal at rest.
    pub reference: Option<TrajectoryPoint>,
    /// Error to the reference in the robot's frame; zero when idle.
    pub error: TrackingError,
    /// Whether a limit of the base changed the law's command.
    pub saturated: bool,
    /// Whether the robot is too far from its reference for the trajectory's guaranteed clearance; a new plan is needed.
    pub off_track: bool,
    /// Whether the robot is at rest at the goal, within the tolerances.
    pub done: bool,
}

/// Longest time between two steps that is counted, s. Larger: the reference jumps farther after a pause. Source: ours.
const MAX_STEP_S: f64 = 0.1;
/// Longest extrapolation of an estimate by its own twist, s. With a larger value, older twists are extrapolated. Source: ours.
const MAX_EXTRAPOLATION_S: f64 = 0.2;

impl Follower {
    /// A follower without a trajectory, of a base at rest.
    ///
    /// # Errors
    /// When a number of the configuration, the drive or the limits is outside its range.
    pub fn new(
        config: FollowerConfig,
        drive: DifferentialDrive,
        limits: DriveLimits,
    ) -> Result<Self, Invalid> {
        let config = config.validated()?;
        Ok(Self {
            tracker: PathTracker::new(config.tracking.clone(), drive, limits)?,
            stabilizer: Stabilizer::new(config.settling.clone(), drive, limits)?,
            limiter: Limiter::new(drive, limits)?,
            config,
            task: None,
            last_step: None,
        })
    }

    /// Follows a trajectory (map frame) from its beginning, then stabilises at `goal`: the end of the trajectory, or its position after a
    /// map correction, some centimetres away. The motion between the two is not checked for obstacles.
    pub fn follow(&mut self, trajectory: Trajectory, goal: Pose2) {
        self.stabilizer.restart();
        self.task = Some(FollowTask { clock: ReferenceClock::new(trajectory), goal, settling: false });
    }

    /// Drops the trajectory: the robot brakes to rest.
    pub fn halt(&mut self) {
        self.task = None;
    }

    /// Sets the twist that was really sent, if it differs from the last one reported (after a safety stop).
    pub fn sent(&mut self, twist: Twist2) {
        self.tracker.sent(twist);
        self.stabilizer.sent(twist);
        self.limiter.sent(twist);
    }

    /// The present reference: a new trajectory that begins here causes no jump. `None` if idle or settling.
    pub fn reference(&self) -> Option<TrajectoryPoint> {
        self.task.as_ref().filter(|task| !task.settling).map(|task| task.clock.reference())
    }

    /// The last pose of the trajectory being followed.
    pub fn end(&self) -> Option<Pose2> {
        self.task.as_ref().map(|task| task.clock.end())
    }

    /// Simulated point stabilisation from `from` at `goal`.
    pub fn preview_stabilization(&self, from: Pose2, goal: Pose2) -> StabilizerPreview {
        self.stabilizer.preview(from, goal)
    }

    /// The command for `now`. An older estimate is extrapolated by its own twist.
    pub fn step(&mut self, estimate: &PoseEstimate, now: Stamp) -> FollowReport {
        let dt = self.last_step.map_or(0.0, |last| (now - last).clamp(0.0, MAX_STEP_S));
        self.last_step = Some(now);
        let age = (now - estimate.stamp).clamp(0.0, MAX_EXTRAPOLATION_S);
        let estimate =
            PoseEstimate { stamp: now, pose: estimate.pose.advance(estimate.twist, age), ..*estimate };
        let report = match &mut self.task {
            None => idle(&mut self.limiter, dt),
            Some(task) => {
                if !task.settling {
                    task.clock.advance(dt, estimate.pose, &self.config);
                    task.settling = task.clock.has_arrived();
                }
                if task.settling {
                    settle(&mut self.stabilizer, &estimate, task, dt)
                } else {
                    track(&mut self.tracker, &estimate, task, dt, &self.config)
                }
            }
        };
        self.sent(report.twist);
        report
    }
}

fn idle(limiter: &mut Limiter, dt: f64) -> FollowReport {
    FollowReport {
        twist: limiter.limit(Twist2::ZERO, dt).twist,
        phase: FollowPhase::Idle,
        reference: None,
        error: TrackingError::default(),
        saturated: false,
        off_track: false,
        done: false,
    }
}

fn track(
    tracker: &mut PathTracker,
    estimate: &PoseEstimate,
    task: &FollowTask,
    dt: f64,
    config: &FollowerConfig,
) -> FollowReport {
    let report = tracker.step(estimate, &task.clock.reference_ahead(config.lead), dt);
    FollowReport {
        twist: report.twist,
        phase: FollowPhase::Tracking,
        reference: Some(task.clock.reference()),
        error: report.error,
        saturated: report.saturated,
        off_track: report.error.distance() > config.stray_distance,
        done: false,
    }
}

fn settle(stabilizer: &mut Stabilizer, estimate: &PoseEstimate, task: &FollowTask, dt: f64) -> FollowReport {
    let report = stabilizer.step(estimate, task.goal, dt);
    let phase = match report.phase {
        StabilizerPhase::Approaching => FollowPhase::Approaching,
        StabilizerPhase::Turning => FollowPhase::Turning,
        StabilizerPhase::Settled => FollowPhase::Settled,
    };
    FollowReport {
        twist: report.twist,
        phase,
        reference: Some(TrajectoryPoint { time: task.clock.time(), pose: task.goal, twist: Twist2::ZERO }),
        error: report.error,
        saturated: report.saturated,
        off_track: false,
        done: report.phase == StabilizerPhase::Settled,
    }
}

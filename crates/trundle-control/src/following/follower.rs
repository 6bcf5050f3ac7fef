use super::{FollowerConfig, clock::ReferenceClock};
use crate::{Limiter, SettlePreview, SettleState, Stabilizer, Tracker, TrackingError};
use std::fmt;
use trundle_core::{
    DifferentialDrive, DriveLimits, Invalid, Pose2, PoseEstimate, Stamp, Trajectory, TrajectoryPoint, Twist2,
};

/// Follows a trajectory and settles at its goal.
#[derive(Debug, Clone, PartialEq)]
pub struct Follower {
    config: FollowerConfig,
    tracker: Tracker,
    stabilizer: Stabilizer,
    brake: Limiter,
    task: Option<Task>,
    last: Option<Stamp>,
}

#[derive(Debug, Clone, PartialEq)]
struct Task {
    clock: ReferenceClock,
    goal: Pose2,
    settling: bool,
}

/// What the follower is at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FollowPhase {
    /// Nothing to follow: it brakes and stands.
    Idle,
    /// Along the trajectory.
    Tracking,
    /// Near the goal, to its position.
    Approaching,
    /// On the goal's position, to its heading.
    Turning,
    /// At the goal, at rest.
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

/// One step of following.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowReport {
    /// The twist to send.
    pub twist: Twist2,
    /// What it is for.
    pub phase: FollowPhase,
    /// Where the robot should be, and how it should be moving; the goal at rest once the trajectory has arrived.
    pub reference: Option<TrajectoryPoint>,
    /// Where that is, seen from the robot; zero when idle.
    pub error: TrackingError,
    /// Whether a limit of the base changed what the law wanted.
    pub saturated: bool,
    /// Whether the robot is too far from its reference to trust the trajectory's room: plan again.
    pub off_track: bool,
    /// Whether the robot stands at the goal, within the tolerances.
    pub done: bool,
}

/// Longer pauses between two steps count as this, s.
const LONGEST_STEP: f64 = 0.1;
/// An older estimate is not extrapolated further than this, s.
const LONGEST_EXTRAPOLATION: f64 = 0.2;

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
            tracker: Tracker::new(config.tracking.clone(), drive, limits)?,
            stabilizer: Stabilizer::new(config.settling.clone(), drive, limits)?,
            brake: Limiter::new(drive, limits)?,
            config,
            task: None,
            last: None,
        })
    }

    /// Takes up a trajectory (map frame), from its beginning, and the goal to settle at: the trajectory's end, or where
    /// the map has moved it since, some centimetres away. The way between the two is not checked for obstacles.
    pub fn follow(&mut self, trajectory: Trajectory, goal: Pose2) {
        self.stabilizer.restart();
        self.task = Some(Task { clock: ReferenceClock::new(trajectory), goal, settling: false });
    }

    /// Forgets the trajectory: the robot brakes and stands.
    pub fn halt(&mut self) {
        self.task = None;
    }

    /// Says what the base was really asked for, where that is not the last twist reported (a safety stop, say).
    pub fn sent(&mut self, twist: Twist2) {
        self.tracker.sent(twist);
        self.stabilizer.sent(twist);
        self.brake.sent(twist);
    }

    /// The reference of now, where a new trajectory should begin so that nothing jumps; `None` when idle or settling.
    pub fn reference(&self) -> Option<TrajectoryPoint> {
        self.task.as_ref().filter(|task| !task.settling).map(|task| task.clock.reference())
    }

    /// The last pose of the trajectory being followed.
    pub fn end(&self) -> Option<Pose2> {
        self.task.as_ref().map(|task| task.clock.end())
    }

    /// How settling from `from` at `goal` would go.
    pub fn preview_settling(&self, from: Pose2, goal: Pose2) -> SettlePreview {
        self.stabilizer.preview(from, goal)
    }

    /// The command for `now`. An estimate that is older is carried forward by its own twist.
    pub fn step(&mut self, estimate: &PoseEstimate, now: Stamp) -> FollowReport {
        let dt = self.last.map_or(0.0, |last| (now - last).clamp(0.0, LONGEST_STEP));
        self.last = Some(now);
        let age = (now - estimate.stamp).clamp(0.0, LONGEST_EXTRAPOLATION);
        let estimate =
            PoseEstimate { stamp: now, pose: estimate.pose.advance(estimate.twist, age), ..*estimate };
        let report = match &mut self.task {
            None => idle(&mut self.brake, dt),
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

fn idle(brake: &mut Limiter, dt: f64) -> FollowReport {
    FollowReport {
        twist: brake.limit(Twist2::ZERO, dt).twist,
        phase: FollowPhase::Idle,
        reference: None,
        error: TrackingError::default(),
        saturated: false,
        off_track: false,
        done: false,
    }
}

fn track(
    tracker: &mut Tracker,
    estimate: &PoseEstimate,
    task: &Task,
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

fn settle(stabilizer: &mut Stabilizer, estimate: &PoseEstimate, task: &Task, dt: f64) -> FollowReport {
    let report = stabilizer.step(estimate, task.goal, dt);
    let phase = match report.state {
        SettleState::Approaching => FollowPhase::Approaching,
        SettleState::Turning => FollowPhase::Turning,
        SettleState::Settled => FollowPhase::Settled,
    };
    FollowReport {
        twist: report.twist,
        phase,
        reference: Some(TrajectoryPoint { time: task.clock.time(), pose: task.goal, twist: Twist2::ZERO }),
        error: report.error,
        saturated: report.saturated,
        off_track: false,
        done: report.state == SettleState::Settled,
    }
}

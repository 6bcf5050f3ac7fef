//! The navigator: from a goal and the world state to a safe twist.

mod camera_fov;
mod commands;
mod known_floor;
mod long_decision;
mod plan_in_view;
mod plans;
mod seek_viewpoint;
#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
mod viewpoint;
mod visibility_constraint;
mod zone_limits;

pub(crate) use commands::safety_input;

use crate::world_state::WorldState;
use crate::{
    behaviour::drive_state::DriveState,
    behaviour::machine::StateMachine,
    behaviour::progress_checker::ProgressChecker,
    behaviour::relative_motion::{RelativeMotion, RelativeMotionDrive},
    behaviour::sight_recovery::SightRecovery,
    behaviour::spin::Spin,
    behaviour::station_drive::{StationDrive, StationGoal},
    bumper,
    config::RobotConfig,
    goal_approach::{GoalApproach, GoalApproachReport},
    mission::executor_config::MissionExecutorConfig,
    operator::RunSetting,
    reason::{Reason, TransitionReason},
    schedule::Ticker,
    stage::{Stage, StageTimes},
};
use camera_fov::CameraFov;
use trundle_control::{FollowPhase, FollowReport, Follower, MotionSense, SafetyMonitor};
use trundle_core::{Footprint, Invalid, Pose2, PoseEstimate, Stamp, Twist2, Vector2};
use trundle_planning::{PlanResult, Planner};
use viewpoint::Viewpoint;
use visibility_constraint::VisibilityConstraint;

/// Decision of a control step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Decision {
    pub(crate) twist: Twist2,
    pub(crate) replanned: bool,
}

/// Goal of the robot, map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Goal {
    /// Stand exactly here.
    Exact(Pose2),
    /// A viewpoint: the robot need not reach it exactly, and skips it if it is blocked.
    Viewpoint(Pose2),
    /// Turns and straight moves onto this pose from near by.
    Align(Pose2),
    /// A motion at a charging station.
    Station(StationGoal),
    /// A motion relative to the robot's present pose.
    Relative(RelativeMotion),
    /// Turn on the spot once.
    Spin,
    /// Stay at the present pose.
    Stay,
}

impl Goal {
    fn pose(self) -> Option<Pose2> {
        match self {
            Self::Exact(pose) | Self::Viewpoint(pose) | Self::Align(pose) => Some(pose),
            Self::Station(_) | Self::Relative(_) | Self::Spin | Self::Stay => None,
        }
    }
}

/// Computes a safe twist from a goal and the world state: plans, follows the trajectory, approaches the goal, and waits. Without a path the
/// robot turns on the spot and observes. The safety monitor checks each twist last. In narrow space docking makes the approach.
#[derive(Debug)]
pub(crate) struct Navigator {
    config: MissionExecutorConfig,
    planner: Planner,
    /// The camera's field of view on the floor; none with a laser as range source.
    camera_fov: Option<CameraFov>,
    follower: Follower,
    goal_approach: GoalApproach,
    safety: SafetyMonitor,
    check_due: Ticker,
    improve_due: Ticker,
    goal: Goal,
    plan: Option<Box<PlanResult>>,
    machine: StateMachine,
    touched: bool,
    /// Bumper contacts since the goal was given.
    touches: u32,
    over_edge: bool,
    started: Option<Stamp>,
    held_since: Option<Stamp>,
    spin: Spin,
    sight_recovery: SightRecovery,
    /// Whether a goal that no path leads to ends, in place of a wait for a path.
    ends_without_path: bool,
    /// Stamp of the first plan without a path since the last plan with one; `None` after a plan with a path.
    no_path_since: Option<Stamp>,
    /// Place where the path to the goal is blocked, if there is no path.
    blocked_at: Option<Vector2>,
    viewpoint: Viewpoint,
    visibility: VisibilityConstraint,
    /// A disc can always turn away.
    is_polygon: bool,
    /// Whether the outline is too near to an obstacle for a turn: the robot backs out, as far as safety permits.
    is_wedged: bool,
    /// Whether the robot is too far from its reference to continue from it.
    is_off_track: bool,
    progress: ProgressChecker,
    /// The safety monitor's timeout of images, s.
    image_timeout: f64,
    /// Radius of the disc around the robot, m.
    radius: f64,
    /// Distance from the base's origin to its front, m.
    reach: f64,
    station_drive: StationDrive,
    relative_drive: RelativeMotionDrive,
    /// Twist of the last step before the safety monitor.
    wanted: Twist2,
    /// Version of the zones that the planner has.
    zones_version: u64,
    /// Whether the plan was made before the zones changed.
    is_before_zones: bool,
}

/// Number of bumper contacts after which the navigator gives up a goal. Source: ours.
const MAX_BUMPER_CONTACTS: u32 = 3;
/// Standard deviation of the position \[m\] above which the position is unknown. Source: ours.
const UNKNOWN_POSITION_SIGMA_M: f64 = 50.0;
/// Duration of a safety stop before the navigator plans again from the present pose \[s\]. Source: ours.
const SAFETY_HOLD_BEFORE_REPLAN_S: f64 = 1.0;

impl Navigator {
    pub(crate) fn new(config: &RobotConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        Ok(Self {
            config: config.mission_executor.validated()?,
            planner: Planner::new(config.planning, footprint, config.limits, config.drive)?,
            camera_fov: CameraFov::of(config)?,
            follower: Follower::new(config.control.clone(), config.drive, config.limits)?,
            goal_approach: GoalApproach::new(&config.docking, footprint)?,
            safety: SafetyMonitor::new(config.safety.clone(), footprint)?,
            check_due: Ticker::new(config.schedule.validated()?.check_hz),
            improve_due: Ticker::new(config.schedule.improve_hz),
            goal: Goal::Stay,
            plan: None,
            machine: StateMachine::default(),
            touched: false,
            touches: 0,
            over_edge: false,
            started: None,
            held_since: None,
            spin: Spin::default(),
            sight_recovery: SightRecovery::default(),
            ends_without_path: false,
            no_path_since: None,
            blocked_at: None,
            viewpoint: Viewpoint::Unknown,
            visibility: VisibilityConstraint::default(),
            is_polygon: matches!(footprint, Footprint::Polygon { .. }),
            is_wedged: false,
            is_off_track: false,
            progress: ProgressChecker::default(),
            image_timeout: config.safety.image_timeout,
            radius: footprint.circumscribed_radius(),
            reach: bumper::front_of(footprint),
            station_drive: StationDrive::default(),
            relative_drive: RelativeMotionDrive::default(),
            wanted: Twist2::ZERO,
            zones_version: 0,
            is_before_zones: false,
        })
    }

    /// Whether goals that no path leads to end, in place of a wait for a path.
    pub(crate) fn end_without_path(&mut self, ends: bool) {
        self.ends_without_path = ends;
    }

    /// Changes a setting. A speed counts from the next plan on.
    pub(crate) fn change(&mut self, setting: RunSetting) {
        match setting {
            RunSetting::Speed(speed) => self.planner.limit_speed(speed),
            RunSetting::Patience(patience) => self.config.patience = patience,
        }
    }

    /// Sets the goal. A robot that follows a trajectory continues to the new goal without a stop.
    pub(crate) fn set_goal(&mut self, goal: Goal) {
        let is_maneuver = matches!(goal, Goal::Align(_) | Goal::Station(_) | Goal::Relative(_));
        let rolls_on = *self.state() == DriveState::Driving && goal.pose().is_some() && !is_maneuver;
        self.goal = goal;
        self.plan = None;
        self.held_since = None;
        self.no_path_since = None;
        self.blocked_at = None;
        self.viewpoint = Viewpoint::Unknown;
        self.visibility.restart();
        self.is_off_track = false;
        self.touches = 0;
        self.sight_recovery = SightRecovery::default();
        self.spin = Spin::default();
        self.goal_approach.reset();
        self.station_drive = StationDrive::default();
        self.relative_drive = RelativeMotionDrive::default();
        self.progress.restart();
        self.check_due.hurry();
        if !rolls_on {
            self.follower.halt();
        }
        let state = match goal {
            Goal::Stay => DriveState::Idle,
            Goal::Exact(_) | Goal::Viewpoint(_) if rolls_on => DriveState::Driving,
            Goal::Align(pose) if self.goal_approach.begin_at(pose) => DriveState::Maneuvering,
            Goal::Station(_) | Goal::Relative(_) => DriveState::Maneuvering,
            _ => DriveState::Initializing,
        };
        self.machine.change(state, TransitionReason::GoalGiven);
    }

    /// A change of the bumper.
    pub(crate) fn touch(&mut self, pressed: bool) {
        self.touches += u32::from(pressed && !self.touched);
        self.touched = pressed;
        if self.touches >= MAX_BUMPER_CONTACTS && !self.state().is_over() {
            // Repeated contacts show that the map lacks the obstacle, or has it at a wrong place.
            self.follower.halt();
            self.goal_approach.reset();
            let reason = Reason::RepeatedContact { contacts: self.touches };
            self.machine.change(DriveState::Stopped { reason }, TransitionReason::RepeatedContact);
        }
    }

    /// A change of the cliff sensors.
    pub(crate) fn cliff(&mut self, over_edge: bool) {
        self.over_edge = over_edge;
    }

    pub(crate) fn state(&self) -> &DriveState {
        self.machine.state()
    }

    /// Report of turns and straight moves for the goal.
    pub(crate) fn docking(&self) -> &GoalApproachReport {
        self.goal_approach.report()
    }

    pub(crate) fn plan(&self) -> Option<&PlanResult> {
        self.plan.as_deref()
    }

    /// Executes one control step: an optional new plan, a command, and the check by the safety monitor.
    pub(crate) fn step(&mut self, s: &WorldState<'_>, times: &mut StageTimes) -> Decision {
        self.take_zones(s);
        self.initialize(s);
        self.monitor(s);
        self.monitor_sight(s);
        let goal = self.goal.pose().filter(|_| self.wants_plan(s));
        let replanned = goal.is_some_and(|goal| times.measure(Stage::Planning, || self.replan(goal, s)));
        let replanned = replanned || self.improved(s, times);
        let follow = times.measure(Stage::Control, || self.follower.step(&s.estimate, s.now));
        self.note_progress(&follow, s, times);
        self.wanted = self.wanted(&follow, s, times);
        let twist = times.measure(Stage::Safety, || self.guard(self.wanted, s));
        self.follower.sent(twist);
        Decision { twist, replanned }
    }

    /// Initializes: the robot does not move before the first view.
    fn initialize(&mut self, s: &WorldState<'_>) {
        self.started.get_or_insert(s.now);
        if *self.state() == DriveState::Initializing && self.is_initialized(s) && self.goal.pose().is_some() {
            self.visibility.home.get_or_insert(s.estimate.pose.position());
            self.machine.change(DriveState::Planning, TransitionReason::Initialized);
        }
    }

    /// Whether the initialization is over: the robot has stood long enough, and a scan exists.
    fn is_initialized(&self, s: &WorldState<'_>) -> bool {
        s.scan.is_some() && self.started.is_some_and(|started| s.now - started >= self.config.opening)
    }

    /// Checks that the pose is known and that the robot makes progress.
    fn monitor(&mut self, s: &WorldState<'_>) {
        if self.state().is_over() {
            return;
        }
        let is_lost = matches!(self.state(), DriveState::Lost { .. });
        match self.lost_reason(s) {
            Some(reason) if !is_lost => {
                self.follower.halt();
                self.goal_approach.reset();
                self.plan = None;
                self.machine.change(DriveState::Lost { reason }, TransitionReason::PoseLost);
            }
            None if is_lost && position_sigma(&s.estimate) < 0.5 * self.config.lost_sigma => {
                self.spin = Spin::default();
                // The robot may have been carried here.
                self.visibility.home = None;
                self.machine.change(DriveState::Initializing, TransitionReason::PoseFound);
            }
            _ => {}
        }
        let turns_count = matches!(self.state(), DriveState::FinalApproach | DriveState::Maneuvering)
            || *self.state() == DriveState::Driving
            || self.goal == Goal::Spin && *self.state() == DriveState::Initializing;
        if s.hold.is_some() {
            // A safety stop is not a fault of the goal.
            return self.progress.restart();
        }
        let stood = self.progress.standing_for(s.now, s.estimate.pose, turns_count);
        if stood > self.config.patience {
            self.stop_without_progress(stood);
        }
    }

    /// Checks whether a usable scan came back after a time without one. If a turn restored the view twice at one place, the path to the
    /// viewpoint leads into the camera's blind range, and the navigator gives up the viewpoint.
    fn monitor_sight(&mut self, s: &WorldState<'_>) {
        if self.is_blind(s) {
            return;
        }
        let is_in_vain = self.sight_recovery.sees(s.estimate.pose.position());
        let waits = matches!(self.state(), DriveState::Waiting { .. });
        if is_in_vain && waits && matches!(self.goal, Goal::Viewpoint(_)) {
            self.follower.halt();
            let reason = Reason::NoSightOnPath;
            self.machine.change(DriveState::Stopped { reason }, TransitionReason::NoSightOnPath);
        }
    }

    /// Returns the reason for an unknown pose; `None` for a known pose.
    fn lost_reason(&self, s: &WorldState<'_>) -> Option<Reason> {
        let sigma = position_sigma(&s.estimate);
        if sigma > UNKNOWN_POSITION_SIGMA_M {
            return Some(Reason::PoseUnknown);
        }
        if sigma > self.config.lost_sigma {
            let is_unresponsive = s.motion != MotionSense::Wheels;
            return Some(if is_unresponsive {
                Reason::WheelsUnresponsive { sigma }
            } else {
                Reason::PoseUncertain { sigma }
            });
        }
        None
    }

    fn stop_without_progress(&mut self, stood: f64) {
        let (state, cause) = (self.state().name(), self.state().reason().cloned().map(Box::new));
        self.follower.halt();
        self.goal_approach.reset();
        let reason = Reason::NoProgress { time: stood, state, cause };
        self.machine.change(DriveState::Stopped { reason }, TransitionReason::NoProgress);
    }

    /// At the end of the trajectory: an arc, or turns and straight moves; or it is near enough.
    fn begin_final_approach(&mut self, s: &WorldState<'_>) {
        self.machine.change(DriveState::FinalApproach, TransitionReason::TrajectoryEnd);
        let (Goal::Exact(goal) | Goal::Align(goal)) = self.goal else {
            self.follower.halt();
            return;
        };
        let preview = self.follower.preview_stabilization(s.estimate.pose, goal);
        self.goal_approach.consider(s, goal, preview);
        self.select_approach(s);
    }

    /// A part of choosing how to settle.
    fn select_approach(&mut self, s: &WorldState<'_>) {
        if self.goal_approach.takes_over(s) {
            self.start_maneuver();
        }
    }

    /// Sets the state by the follower's phase.
    fn note_progress(&mut self, follow: &FollowReport, s: &WorldState<'_>, times: &mut StageTimes) {
        self.note_viewpoint(follow, s.now);
        let moving = matches!(self.state(), DriveState::Driving | DriveState::FinalApproach);
        match follow.phase {
            _ if !moving => {}
            FollowPhase::Settled => self.machine.change(DriveState::Arrived, TransitionReason::GoalReached),
            FollowPhase::Approaching | FollowPhase::Turning if *self.state() == DriveState::Driving => {
                times.measure(Stage::Planning, || self.begin_final_approach(s));
            }
            FollowPhase::Approaching | FollowPhase::Turning => {
                times.measure(Stage::Planning, || self.select_approach(s));
            }
            FollowPhase::Tracking if follow.off_track => {
                self.is_off_track = true;
                self.plan = None;
            }
            FollowPhase::Tracking | FollowPhase::Idle => {}
        }
    }
}

/// The larger standard deviation of the position, m.
pub(crate) fn position_sigma(estimate: &PoseEstimate) -> f64 {
    let block = estimate.covariance.fixed_view::<2, 2>(0, 0);
    let (mean, half) = ((block[(0, 0)] + block[(1, 1)]) / 2.0, (block[(0, 0)] - block[(1, 1)]) / 2.0);
    (mean + half.hypot(block[(0, 1)])).max(0.0).sqrt()
}

//! The components that the states share.

use super::contacts::Contacts;
use super::goal::Goal;
use super::opening::Opening;
use super::path_planner::PathPlanner;
use super::progress_checker::guard::ProgressGuard;
use super::view_monitor::ViewMonitor;
use crate::mission::{GoalOptions, WhenBlocked};
use crate::{bumper, config::RobotConfig, goal_approach::GoalApproach, schedule::Ticker};
use trundle_control::Follower;
use trundle_core::{Footprint, Invalid, Pose2, PoseBound};
use trundle_planning::PlanResult;

/// The components that the states share. A component holds no state of the drive.
#[derive(Debug)]
pub(crate) struct Tools {
    pub(crate) goal: Goal,
    /// How the robot drives to the goal; a setting that is `None` is that of the robot file.
    pub(crate) options: GoalOptions,
    /// The robot file's settings of goals.
    pub(crate) default_options: GoalOptions,
    pub(crate) guard: ProgressGuard,
    pub(crate) planner: PathPlanner,
    /// The newest plan to the goal; none after its rejection.
    pub(crate) plan: Option<PresentPlan>,
    pub(crate) follower: Follower,
    pub(crate) goal_approach: GoalApproach,
    pub(crate) contacts: Contacts,
    pub(crate) view_monitor: ViewMonitor,
    pub(crate) opening: Opening,
    pub(crate) schedule: PlanSchedule,
    /// Whether a goal that no path leads to ends, in place of a wait for a path.
    pub(crate) ends_without_path: bool,
    pub(crate) body: BodyShape,
    pub(crate) arrival: ArrivalCheck,
}

/// The times of searches for a plan.
#[derive(Debug)]
pub(crate) struct PlanSchedule {
    /// Of checks of the present plan, and of searches without a plan.
    pub(crate) check_due: Ticker,
    /// Of searches for a faster plan.
    pub(crate) improve_due: Ticker,
}

/// The certainty that an arrival needs.
#[derive(Debug)]
pub(crate) struct ArrivalCheck {
    /// Largest bound of the pose at which an arrival at an exact goal counts.
    pub(crate) bound: PoseBound,
    /// Turns on the spot at the present goal because of an uncertain pose.
    pub(crate) confirmations: u32,
}

/// A plan, and the zones that it respects.
#[derive(Debug)]
pub(crate) struct PresentPlan {
    pub(crate) result: Box<PlanResult>,
    /// Version of the zones at the time of planning.
    pub(crate) zones_version: u64,
}

/// The dimensions of the robot that the states need.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BodyShape {
    /// Whether the footprint is a polygon. A disc can always turn away.
    pub(crate) is_polygon: bool,
    /// Radius of the disc around the robot, m.
    pub(crate) radius: f64,
    /// Distance from the base's origin to its front, m.
    pub(crate) reach: f64,
}

impl Tools {
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub(crate) fn new(config: &RobotConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        Ok(Self {
            goal: Goal::Stay,
            options: GoalOptions::default(),
            default_options: default_options(config),
            guard: ProgressGuard::default(),
            planner: PathPlanner::new(config, footprint)?,
            plan: None,
            follower: Follower::new(config.control.clone(), config.drive, config.limits)?,
            goal_approach: GoalApproach::new(&config.docking, footprint)?,
            contacts: Contacts::default(),
            view_monitor: ViewMonitor::new(config.safety.image_timeout),
            opening: Opening::new(config.mission_executor.opening),
            schedule: PlanSchedule {
                check_due: Ticker::new(config.schedule.validated()?.check_hz),
                improve_due: Ticker::new(config.schedule.improve_hz),
            },
            ends_without_path: false,
            body: BodyShape::of(footprint),
            arrival: ArrivalCheck { bound: config.mission_executor.arrival_bound(), confirmations: 0 },
        })
    }

    /// Prepares for another goal. A robot that rolls on keeps its trajectory until the next plan.
    pub(crate) fn restart(&mut self, goal: Goal, options: GoalOptions, rolls_on: bool) {
        self.goal = goal;
        self.options = options.or(&self.default_options);
        self.planner.planner.set_goal_tolerance(self.options.tolerance.unwrap_or(0.0));
        self.guard.restart();
        self.arrival.confirmations = 0;
        self.plan = None;
        self.planner.visibility.restart();
        self.contacts.restart();
        self.view_monitor.restart();
        self.goal_approach.reset();
        self.schedule.check_due.make_due();
        if !rolls_on {
            self.follower.halt();
        }
    }

    /// Changes the patience of goals \[s\]. A goal with its own patience keeps it.
    pub(crate) fn set_patience(&mut self, patience: f64) {
        if self.options.patience == self.default_options.patience {
            self.options.patience = Some(patience);
        }
        self.default_options.patience = Some(patience);
    }

    /// Ends every motion: the robot brakes to rest.
    pub(crate) fn halt(&mut self) {
        self.follower.halt();
        self.goal_approach.reset();
    }

    /// Whether the goal asks to wait for a blocked path. A viewpoint is skipped.
    pub(crate) fn waits_when_blocked(&self) -> bool {
        self.options.when_blocked == Some(WhenBlocked::Wait) && !self.goal.is_viewpoint()
    }

    /// Takes up a plan, and follows it: to the goal, or near a blocked goal with a tolerance to the end of the trajectory.
    pub(crate) fn follow(&mut self, result: Box<PlanResult>, goal: Pose2) {
        let end = if result.instead_of.is_some() { result.trajectory.end() } else { goal };
        self.follower.follow(result.trajectory.clone(), end);
        self.guard.follow(result.trajectory.clone());
        self.plan = Some(PresentPlan { result, zones_version: self.planner.zones_version() });
    }
}

/// The robot file's settings of goals.
fn default_options(config: &RobotConfig) -> GoalOptions {
    let tolerance = config.planning.goal_tolerance;
    GoalOptions {
        patience: Some(config.mission_executor.patience),
        when_blocked: Some(config.mission_executor.when_blocked),
        tolerance: (tolerance > 0.0).then_some(tolerance),
        heading_tolerance: None,
        pass_through: false,
    }
}

impl BodyShape {
    fn of(footprint: &Footprint) -> Self {
        Self {
            is_polygon: matches!(footprint, Footprint::Polygon { .. }),
            radius: footprint.circumscribed_radius(),
            reach: bumper::front_of(footprint),
        }
    }
}

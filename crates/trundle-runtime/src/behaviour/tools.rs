//! The components that the states share.

use super::contacts::Contacts;
use super::goal::Goal;
use super::opening::Opening;
use super::path_planner::PathPlanner;
use super::sight::Sight;
use crate::{bumper, config::RobotConfig, goal_approach::GoalApproach, schedule::Ticker};
use trundle_control::Follower;
use trundle_core::{Footprint, Invalid};
use trundle_planning::PlanResult;

/// The components that the states share. A component holds no state of the drive.
#[derive(Debug)]
pub(crate) struct Tools {
    pub(crate) goal: Goal,
    pub(crate) planner: PathPlanner,
    /// The newest plan to the goal; none after its rejection.
    pub(crate) plan: Option<PresentPlan>,
    pub(crate) follower: Follower,
    pub(crate) goal_approach: GoalApproach,
    pub(crate) contacts: Contacts,
    pub(crate) sight: Sight,
    pub(crate) opening: Opening,
    pub(crate) check_due: Ticker,
    pub(crate) improve_due: Ticker,
    /// Whether a goal that no path leads to ends, in place of a wait for a path.
    pub(crate) ends_without_path: bool,
    pub(crate) body: BodyShape,
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
            planner: PathPlanner::new(config, footprint)?,
            plan: None,
            follower: Follower::new(config.control.clone(), config.drive, config.limits)?,
            goal_approach: GoalApproach::new(&config.docking, footprint)?,
            contacts: Contacts::default(),
            sight: Sight::new(config.safety.image_timeout),
            opening: Opening::new(config.mission_executor.opening),
            check_due: Ticker::new(config.schedule.validated()?.check_hz),
            improve_due: Ticker::new(config.schedule.improve_hz),
            ends_without_path: false,
            body: BodyShape::of(footprint),
        })
    }

    /// Prepares for another goal. A robot that rolls on keeps its trajectory until the next plan.
    pub(crate) fn restart(&mut self, goal: Goal, rolls_on: bool) {
        self.goal = goal;
        self.plan = None;
        self.planner.visibility.restart();
        self.contacts.restart();
        self.sight.restart();
        self.goal_approach.reset();
        self.check_due.hurry();
        if !rolls_on {
            self.follower.halt();
        }
    }

    /// Ends every motion: the robot brakes to rest.
    pub(crate) fn halt(&mut self) {
        self.follower.halt();
        self.goal_approach.reset();
    }

    /// Takes up a plan, and follows it.
    pub(crate) fn follow(&mut self, result: Box<PlanResult>, goal: trundle_core::Pose2) {
        self.follower.follow(result.trajectory.clone(), goal);
        self.plan = Some(PresentPlan { result, zones_version: self.planner.zones_version() });
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

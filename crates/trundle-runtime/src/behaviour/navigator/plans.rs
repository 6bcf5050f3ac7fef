//! Time and start pose of planning, and the reactions to a missing path.

use super::{Goal, Navigator, SAFETY_HOLD_BEFORE_REPLAN_S, plan_in_view::InView, viewpoint::Viewpoint};
use crate::world_state::WorldState;
use crate::{
    behaviour::drive_state::DriveState,
    behaviour::spin::Spin,
    reason::{NoPath, Reason, TransitionReason},
    stage::{Stage, StageTimes},
};
use trundle_core::{Pose2, Stamp, Twist2, Vector2};
use trundle_planning::{Plan, PlanResult};

/// Remaining duration of a trajectory \[s\] below which it is driven as planned. Source: ours.
const MIN_IMPROVABLE_S: f64 = 0.5;
/// Time that a new trajectory must save to replace a good one \[s\]. Source: ours.
const MIN_TIME_GAIN_S: f64 = 0.05;
/// Speed below which the robot counts as at rest \[m/s\]. Source: ours.
const STANDING_SPEED_M_S: f64 = 0.02;
/// Number of turns of a search for sight: each bearing is seen twice. Source: ours.
const MAX_SPINS: f64 = 2.0;
/// Time without any path after which a goal ends if the goal does not wait for a path \[s\]: 30 images, ten plans. A single noisy image
/// therefore ends no goal. Source: ours.
const NO_PATH_CONFIRMATION_S: f64 = 2.0;

impl Navigator {
    /// Whether a plan is due: at the beginning, or after a check rejects the old plan.
    pub(super) fn wants_plan(&mut self, s: &WorldState<'_>) -> bool {
        match self.state() {
            DriveState::Idle | DriveState::Arrived | DriveState::Stopped { .. } => false,
            DriveState::Initializing
            | DriveState::FinalApproach
            | DriveState::Maneuvering
            | DriveState::Lost { .. } => false,
            DriveState::Recovering { .. } if !self.needs_new_plan(s) => {
                if self.check_due.due(s.now) {
                    self.watch_path_to_viewpoint(s);
                }
                false
            }
            DriveState::Planning | DriveState::Recovering { .. } => self.check_due.due(s.now),
            DriveState::Waiting { .. } if self.touched || self.over_edge || self.is_blind(s) => false,
            DriveState::Waiting { .. }
                if self.held_since.is_some_and(|since| s.now - since < SAFETY_HOLD_BEFORE_REPLAN_S) =>
            {
                false
            }
            DriveState::Waiting { .. } => self.check_due.due(s.now),
            DriveState::Driving => {
                self.check_due.due(s.now)
                    && (std::mem::take(&mut self.is_before_zones) || !self.plan_holds(s))
            }
        }
    }

    /// Whether the rest of the trajectory is free on the newest map, has its floor observed in time, and meets no moving obstacle.
    fn plan_holds(&self, s: &WorldState<'_>) -> bool {
        match (&self.plan, self.follower.reference()) {
            (Some(plan), Some(reference)) => {
                let meets = || {
                    self.planner.first_encounter(&plan.trajectory, reference.time, s.dynamic_obstacles.movers)
                };
                self.is_still_good(&plan.trajectory, reference.time, s) && meets().is_none()
            }
            (Some(_), None) => true,
            (None, _) => false,
        }
    }

    /// Plans from the reference if the robot follows it, else from the robot's pose; returns whether a new plan exists.
    pub(super) fn replan(&mut self, goal: Pose2, s: &WorldState<'_>) -> bool {
        if let Some(zone) = s.zones.masks.and_then(|masks| masks.no_go_zone_at(goal)) {
            let zone = zone.label();
            self.without_path(NoPath::GoalInZone { zone }, s);
            return false;
        }
        if matches!(self.state(), DriveState::Waiting { .. }) && self.starts_maneuver_if_possible(goal, s) {
            return false;
        }
        let from = match (self.state(), self.follower.reference()) {
            (DriveState::Driving, Some(_)) if self.is_off_track => (s.estimate.pose, s.estimate.twist),
            (DriveState::Driving, Some(reference)) => (reference.pose, reference.twist),
            // On the path to a viewpoint the plan starts from the reference too.
            (DriveState::Recovering { .. }, Some(reference))
                if matches!(self.viewpoint, Viewpoint::Going(..)) =>
            {
                (reference.pose, reference.twist)
            }
            _ => (s.estimate.pose, Twist2::ZERO),
        };
        let plan = match self.plan_in_view(s, from, goal) {
            InView::Plan(plan) => plan,
            InView::Asking => return self.stop_for_path_in_view(s),
            InView::Unseen(at, long) => match self.observe_first(at, long, s) {
                Some(long) => Plan::Found(long),
                None => return false,
            },
        };
        match plan {
            Plan::Found(plan) if plan.is_continuous || s.estimate.twist.v.abs() < STANDING_SPEED_M_S => {
                self.follower.follow(plan.trajectory.clone(), goal);
                self.plan = Some(plan);
                self.machine.change(DriveState::Driving, TransitionReason::PlanFound);
                self.held_since = None;
                self.no_path_since = None;
                self.blocked_at = None;
                self.viewpoint = Viewpoint::Unknown;
                self.is_off_track = false;
                self.spin = Spin::default();
                true
            }
            Plan::Found(_) => {
                self.hold(Reason::StoppingToReplan, TransitionReason::StoppingToReplan, s.now);
                false
            }
            Plan::Blocked { .. } if self.is_free_but_for_movers(s, from, goal) => {
                self.no_path_since = None;
                self.hold(Reason::MovingObstacle, TransitionReason::MovingObstacle, s.now);
                false
            }
            refused => {
                if !self.starts_maneuver_if_possible(goal, s)
                    && let Some(cause) = NoPath::of(&refused)
                {
                    self.without_path(cause, s);
                }
                false
            }
        }
    }

    /// Handles a path that enters unseen floor at `at`: the robot drives to a viewpoint of that floor. Without a viewpoint the robot takes
    /// the `long` path.
    fn observe_first(
        &mut self,
        at: Vector2,
        long: Option<Box<PlanResult>>,
        s: &WorldState<'_>,
    ) -> Option<Box<PlanResult>> {
        if *self.state() == DriveState::Driving {
            self.stop_for_path_in_view(s);
            return None;
        }
        if self.seeks_view_of(at, s) {
            if !matches!(self.viewpoint, Viewpoint::Going(..)) {
                self.follower.halt();
                self.plan = None;
            }
            let reason = Reason::UnseenFloor { at };
            self.machine.change(DriveState::Recovering { reason }, TransitionReason::UnseenFloor);
            self.held_since = None;
            return None;
        }
        self.viewpoint = Viewpoint::Unknown;
        if long.is_none() && self.visibility.bar(at, s.now) {
            // The next plan avoids this floor.
            self.stop_for_path_in_view(s);
        } else if long.is_none() {
            self.without_path(NoPath::Blocked { nearest: at }, s);
        }
        long
    }

    /// Stops a drive whose path is not observed in time, until another plan exists. Returns false: no new plan exists.
    fn stop_for_path_in_view(&mut self, s: &WorldState<'_>) -> bool {
        if *self.state() == DriveState::Driving {
            self.hold(Reason::PathOutOfView, TransitionReason::PathOutOfView, s.now);
        }
        false
    }

    /// Whether only moving obstacles block the path.
    fn is_free_but_for_movers(&mut self, s: &WorldState<'_>, from: (Pose2, Twist2), goal: Pose2) -> bool {
        !s.dynamic_obstacles.movers.is_empty()
            && matches!(self.planner.plan(s.permitted_floor(), from.0, from.1, goal), Plan::Found(_))
    }

    /// During a drive: a new plan that continues from the reference and arrives sooner replaces the old one.
    pub(super) fn improved(&mut self, s: &WorldState<'_>, times: &mut StageTimes) -> bool {
        let (Some(goal), DriveState::Driving) = (self.goal.pose(), self.state()) else { return false };
        let (Some(old), Some(reference)) = (&self.plan, self.follower.reference()) else { return false };
        let left = old.trajectory.duration() - reference.time;
        if left < MIN_IMPROVABLE_S || !self.improve_due.due(s.now) {
            return false;
        }
        let planner = &mut self.planner;
        let plan = times.measure(Stage::Planning, || {
            planner.plan_among_moving(
                s.permitted_floor(),
                s.dynamic_obstacles.movers,
                reference.pose,
                reference.twist,
                goal,
            )
        });
        match plan {
            // A faster path must also avoid the unseen floor that the present path avoids.
            Plan::Found(plan)
                if plan.is_continuous
                    && plan.trajectory.duration() < left - MIN_TIME_GAIN_S
                    && self.first_unseen(plan.trajectory.points(), s.floor()).is_none() =>
            {
                self.follower.follow(plan.trajectory.clone(), goal);
                self.plan = Some(plan);
                true
            }
            _ => false,
        }
    }

    /// Reaction to a missing path: stops, turns on the spot until the surroundings are observed, drives to a viewpoint of the blocked
    /// place, and waits with the camera on that place.
    fn without_path(&mut self, cause: NoPath, s: &WorldState<'_>) {
        let is_final = self.is_final(&cause, s.now);
        if matches!(self.viewpoint, Viewpoint::Going(..)) {
            let reason = self.no_path(cause);
            self.machine.change(DriveState::Recovering { reason }, TransitionReason::NoPath);
            return;
        }
        self.is_wedged = self.is_polygon && matches!(cause, NoPath::StartInObstacle { .. });
        self.follower.halt();
        self.plan = None;
        self.blocked_at = match &cause {
            NoPath::Blocked { nearest } => Some(*nearest),
            _ => self.goal.pose().map(|goal| goal.position()),
        };
        let reason = self.no_path(cause);
        let has_looked = self.spin.has_turned(MAX_SPINS) && !self.is_wedged;
        let state = if is_final {
            DriveState::Stopped { reason }
        } else if has_looked && !self.seeks_viewpoint(s) {
            DriveState::Waiting { reason }
        } else {
            DriveState::Recovering { reason }
        };
        self.machine.change(state, TransitionReason::NoPath);
    }

    /// Whether the goal ends without a wait for a path. A viewpoint ends immediately; another goal that does not wait ends if no path
    /// exists over known or unknown floor.
    fn is_final(&mut self, cause: &NoPath, now: Stamp) -> bool {
        let since = *self.no_path_since.get_or_insert(now);
        let is_at_goal = !matches!(cause, NoPath::StartInObstacle { .. } | NoPath::StartOutside);
        // Floor kept out of the search may be observed later, as long as observations are left.
        let is_kept_out = self.visibility.keep_out().is_some() && !self.visibility.is_exhausted();
        let is_proven = is_at_goal && !is_kept_out && now - since >= NO_PATH_CONFIRMATION_S;
        matches!(self.goal, Goal::Viewpoint(_)) || self.ends_without_path && is_proven
    }

    /// Starts a manoeuvre of turns and straight moves near the goal, if no path is found or the safety monitor stops the robot.
    fn starts_maneuver_if_possible(&mut self, goal: Pose2, s: &WorldState<'_>) -> bool {
        let stands = s.estimate.twist.v.abs() < STANDING_SPEED_M_S;
        let is_exact = matches!(self.goal, Goal::Exact(_));
        let turned = is_exact && stands && !self.is_blind(s) && self.goal_approach.begin_if_possible(s, goal);
        if turned {
            self.start_maneuver();
        }
        turned
    }

    pub(super) fn start_maneuver(&mut self) {
        self.follower.halt();
        self.held_since = None;
        self.machine.change(DriveState::Maneuvering, TransitionReason::ManeuverChosen);
    }

    /// The reason for a missing path, with the floor excluded from the search.
    fn no_path(&self, cause: NoPath) -> Reason {
        Reason::NoPath { cause, unseen: self.visibility.keep_out() }
    }

    fn hold(&mut self, reason: Reason, why: TransitionReason, now: Stamp) {
        self.follower.halt();
        self.held_since.get_or_insert(now);
        self.machine.change(DriveState::Waiting { reason }, why);
    }
}

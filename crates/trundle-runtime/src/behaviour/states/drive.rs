//! Drive: following a trajectory.

use super::replan::{Planned, Query, replan};
use super::{approach, arrival};
use crate::behaviour::path_search::PathSearch;
use crate::behaviour::state::{Drive, Next, State, Wait};
use crate::behaviour::tools::Tools;
use crate::reason::{Reason, TransitionReason};
use crate::stage::{Stage, StageTimes};
use crate::world_state::WorldState;
use trundle_control::{FollowPhase, FollowReport, StopReason};
use trundle_core::{Pose2, Twist2};
use trundle_planning::Plan;

/// Remaining duration of a trajectory \[s\] below which it is driven as planned. Source: ours.
const MIN_IMPROVABLE_S: f64 = 0.5;
/// Time that a new trajectory must save to replace a good one \[s\]. Source: ours.
const MIN_TIME_GAIN_S: f64 = 0.05;

impl Drive {
    /// Plans again once a check rejects the plan.
    pub(crate) fn plan(&mut self, tools: &mut Tools, s: &WorldState<'_>, times: &mut StageTimes) -> Planned {
        let Some(goal) =
            tools.goal.pose().filter(|_| tools.schedule.check_due.due(s.now) && !plan_holds(tools, s))
        else {
            return Planned::default();
        };
        let query = Query { goal, from: self.start(tools, s), is_driving: true };
        times.measure(Stage::Planning, || replan(tools, &mut PathSearch::default(), &query, s))
    }

    /// Pose and twist from which a new plan continues: the reference, if the robot follows it.
    fn start(&self, tools: &Tools, s: &WorldState<'_>) -> (Pose2, Twist2) {
        match tools.follower.reference() {
            Some(_) if self.is_off_track => (s.estimate.pose, s.estimate.twist),
            Some(reference) => (reference.pose, reference.twist),
            None => (s.estimate.pose, Twist2::ZERO),
        }
    }

    /// Reads the follower's phase: the end of the trajectory, or a robot that is off its reference.
    pub(crate) fn on_follow(
        &mut self,
        tools: &mut Tools,
        follow: &FollowReport,
        s: &WorldState<'_>,
        times: &mut StageTimes,
    ) -> Next {
        match follow.phase {
            FollowPhase::Settled => arrival::arrive(tools, s),
            FollowPhase::Approaching | FollowPhase::Turning => {
                times.measure(Stage::Planning, || approach::begin(tools, s))
            }
            FollowPhase::Tracking if follow.off_track => {
                self.is_off_track = true;
                tools.plan = None;
                None
            }
            FollowPhase::Tracking | FollowPhase::Idle => None,
        }
    }

    /// Waits, with the trajectory kept.
    pub(crate) fn on_stop(
        &mut self,
        tools: &mut Tools,
        wanted: Twist2,
        stop: StopReason,
        s: &WorldState<'_>,
    ) -> Next {
        tools.view_monitor.held(wanted);
        let interrupted = tools.follower.end().map(|_| *self);
        let wait = Wait { reason: Reason::Safety(stop), search: PathSearch::held(s.now), interrupted };
        State::Wait(wait).because(TransitionReason::SafetyStop)
    }
}

/// Whether the rest of the trajectory respects the newest zones, is free on the newest map, has its floor observed in time, and meets no
/// moving obstacle.
fn plan_holds(tools: &Tools, s: &WorldState<'_>) -> bool {
    let Some(plan) = &tools.plan else { return false };
    if plan.zones_version != tools.planner.zones_version() {
        return false;
    }
    let Some(reference) = tools.follower.reference() else { return true };
    let (way, planner) = (&plan.result.trajectory, &tools.planner);
    let meets = || planner.planner.first_encounter(way, reference.time, s.dynamic_obstacles.movers);
    planner.is_still_good(way, reference.time, s) && meets().is_none()
}

/// A new plan that continues from the reference and arrives sooner replaces the old one; returns whether there is one.
pub(crate) fn improve(tools: &mut Tools, s: &WorldState<'_>, times: &mut StageTimes) -> bool {
    let Some(goal) = tools.goal.pose() else { return false };
    let (Some(old), Some(reference)) = (&tools.plan, tools.follower.reference()) else { return false };
    let left = old.result.trajectory.duration() - reference.time;
    if left < MIN_IMPROVABLE_S || !tools.schedule.improve_due.due(s.now) {
        return false;
    }
    let from = (reference.pose, reference.twist);
    let plan = times.measure(Stage::Planning, || tools.planner.plan_among_moving(s, from, goal));
    match plan {
        // A faster path must also avoid the unseen floor that the present path avoids.
        Plan::Found(plan)
            if plan.is_continuous
                && plan.trajectory.duration() < left - MIN_TIME_GAIN_S
                && tools.planner.first_unseen(plan.trajectory.points(), s.floor()).is_none() =>
        {
            tools.follow(plan, goal);
            true
        }
        _ => false,
    }
}

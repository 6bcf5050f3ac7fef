//! Approach: point stabilisation onto the exact goal. Face: a turn to the heading of a viewpoint.

use super::{arrival, maneuver};
use crate::behaviour::goal::Goal;
use crate::behaviour::path_search::PathSearch;
use crate::behaviour::spin::turn_to;
use crate::behaviour::state::{Change, Drive, Next, State, Wait};
use crate::behaviour::tools::Tools;
use crate::mission::GoalOptions;
use crate::reason::{Reason, TransitionReason};
use crate::stage::{Stage, StageTimes};
use crate::world_state::WorldState;
use trundle_control::{FollowPhase, FollowReport, StopReason};
use trundle_core::Twist2;

/// At the end of the trajectory: an arc, or turns and straight moves; at a viewpoint a turn.
pub(crate) fn begin(tools: &mut Tools, s: &WorldState<'_>) -> Next {
    if let Some(next) = arrive_within_tolerance(tools, s) {
        return Some(next);
    }
    let goal = match tools.goal {
        Goal::Exact(goal) | Goal::Align(goal) => goal,
        other => {
            tools.follower.halt();
            let heading = other.pose().map_or(s.estimate.pose.theta, |pose| pose.theta);
            return State::Face(heading).because(TransitionReason::TrajectoryEnd);
        }
    };
    let preview = tools.follower.preview_stabilization(s.estimate.pose, goal);
    tools.goal_approach.consider(s, goal, preview);
    select(tools, s).or_else(|| State::Approach.because(TransitionReason::TrajectoryEnd))
}

/// At the end of the trajectory to a goal with a tolerance: the arrival, or a turn to the goal's heading.
fn arrive_within_tolerance(tools: &mut Tools, s: &WorldState<'_>) -> Option<Change> {
    let (goal, pose, options) = (tools.goal.pose()?, s.estimate.pose, tools.options);
    let position_alone = GoalOptions { heading_tolerance: None, ..options };
    if !position_alone.is_arrival(&pose, &goal) {
        return None;
    }
    tools.follower.halt();
    if options.is_arrival(&pose, &goal) {
        return arrival::arrive(tools, s);
    }
    State::Face(goal.theta).because(TransitionReason::TrajectoryEnd)
}

/// A part of the choice between the arc, and turns and straight moves.
fn select(tools: &mut Tools, s: &WorldState<'_>) -> Next {
    if tools.goal_approach.takes_over(s) { maneuver::begin(tools) } else { None }
}

/// Reads the follower's phase.
pub(crate) fn on_follow(
    tools: &mut Tools,
    follow: &FollowReport,
    s: &WorldState<'_>,
    times: &mut StageTimes,
) -> Next {
    match follow.phase {
        FollowPhase::Settled => arrival::arrive(tools, s),
        FollowPhase::Approaching | FollowPhase::Turning => {
            times.measure(Stage::Planning, || select(tools, s))
        }
        FollowPhase::Tracking | FollowPhase::Idle => None,
    }
}

/// The command of the arc. At rest until the choice is made, if the arc is not free.
pub(crate) fn tick(tools: &Tools, follow: &FollowReport) -> (Twist2, Next) {
    (if tools.goal_approach.holds() { Twist2::ZERO } else { follow.twist }, None)
}

/// Turns roughly to the heading of a viewpoint; the field of view is wide.
pub(crate) fn face(heading: f64, tools: &mut Tools, s: &WorldState<'_>) -> (Twist2, Next) {
    let twist = turn_to(s.estimate.pose, heading);
    let is_done = twist == Twist2::ZERO;
    (twist, if is_done { arrival::arrive(tools, s) } else { None })
}

/// Waits; the arc begins again after the wait. The turn to a viewpoint needs another plan.
pub(crate) fn on_stop(tools: &mut Tools, wanted: Twist2, stop: StopReason, s: &WorldState<'_>) -> Next {
    tools.view_monitor.held(wanted);
    let interrupted = tools.follower.end().map(|_| Drive::default());
    let wait = Wait { reason: Reason::Safety(stop), search: PathSearch::held(s.now), interrupted };
    State::Wait(wait).because(TransitionReason::SafetyStop)
}

//! A plan to the goal, and the reactions to a missing path. Shared by the states that plan.

use super::detour::{Detour, detour};
use super::maneuver::{STANDING_SPEED_M_S, begin_if_possible};
use crate::behaviour::path_planner::{InView, UnseenPath};
use crate::behaviour::path_search::PathSearch;
use crate::behaviour::path_search::viewpoint::Viewpoint;
use crate::behaviour::progress_checker::rest::length;
use crate::behaviour::state::{Change, Drive, Next, Recover, State, Wait};
use crate::behaviour::tools::Tools;
use crate::reason::{NoPath, Reason, TransitionReason};
use crate::world_state::WorldState;
use std::ops::ControlFlow;
use trundle_core::{Pose2, Stamp, Twist2, Vector2};
use trundle_planning::{Plan, PlanResult};

/// Number of turns of a search for sight: each bearing is seen twice. Source: ours.
const MAX_SPINS: f64 = 2.0;
/// Time without any path after which a goal ends if the goal does not wait for a path \[s\]: 30 images, ten plans. A single noisy image
/// therefore ends no goal. Source: ours.
const NO_PATH_CONFIRMATION_S: f64 = 2.0;

/// A search for a path.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Query {
    pub(crate) goal: Pose2,
    /// Pose and twist at the begin of the path.
    pub(crate) from: (Pose2, Twist2),
    /// Whether the robot follows a trajectory to the goal.
    pub(crate) is_driving: bool,
}

/// Result of a search for a path.
#[derive(Debug, Default)]
pub(crate) struct Planned {
    pub(crate) next: Next,
    /// Whether a new plan exists.
    pub(crate) is_new: bool,
}

impl Planned {
    /// A change of state without a new plan.
    pub(crate) fn to(next: Next) -> Self {
        Self { next, is_new: false }
    }
}

/// Plans along floor that the camera observes in time, and reacts to the result. An unfinished search keeps its data in `search`.
pub(crate) fn replan(
    tools: &mut Tools,
    search: &mut PathSearch,
    query: &Query,
    s: &WorldState<'_>,
) -> Planned {
    if let Some(zone) = no_go_zone(query.goal, s) {
        return Planned::to(without_path(tools, search, zone, s));
    }
    let plan = match tools.planner.plan_in_view(s, query.from, query.goal) {
        InView::Plan(plan) => plan,
        InView::Asking => return Planned::to(stop_for_path_in_view(tools, search, query, s)),
        InView::Unseen(path) => match observe_first(tools, search, query, path, s) {
            ControlFlow::Continue(seen) => Plan::Found(seen),
            ControlFlow::Break(next) => return Planned::to(next),
        },
    };
    react(tools, search, query, plan, s)
}

/// Follows a plan, or reacts to a missing path.
fn react(
    tools: &mut Tools,
    search: &mut PathSearch,
    query: &Query,
    plan: Plan,
    s: &WorldState<'_>,
) -> Planned {
    match plan {
        Plan::Found(plan) if plan.is_continuous || s.estimate.twist.v.abs() < STANDING_SPEED_M_S => {
            let new = length(&plan.trajectory, 0.0, tools.body.radius);
            if let Some(wait) = judge_detour(tools, search, new, s) {
                return Planned::to(Some(wait));
            }
            if !query.is_driving {
                tools.guard.start_drive(s.now);
            }
            tools.follow(plan, query.goal);
            let next = State::Drive(Drive::default()).because(TransitionReason::PlanFound);
            Planned { next, is_new: true }
        }
        Plan::Found(_) => {
            let why = (Reason::StoppingToReplan, TransitionReason::StoppingToReplan);
            Planned::to(hold(tools, search, why, s.now))
        }
        Plan::Blocked { .. } if tools.planner.is_free_but_for_movers(s, query.from, query.goal) => {
            search.no_path_since = None;
            let why = (Reason::MovingObstacle, TransitionReason::MovingObstacle);
            Planned::to(hold(tools, search, why, s.now))
        }
        refused => Planned::to(
            begin_if_possible(tools, query.goal, s)
                .or_else(|| without_path(tools, search, NoPath::of(&refused)?, s)),
        ),
    }
}

/// The no-go zone that holds the goal.
pub(crate) fn no_go_zone(goal: Pose2, s: &WorldState<'_>) -> Option<NoPath> {
    let zone = s.zones.masks?.no_go_zone_at(goal)?;
    Some(NoPath::GoalInZone { zone: zone.label() })
}

/// Handles a path that enters unseen floor at a place: the robot drives to a viewpoint of that floor. Without a viewpoint the robot takes
/// the long path, if there is one. A break holds the change of state, if any.
fn observe_first(
    tools: &mut Tools,
    search: &mut PathSearch,
    query: &Query,
    UnseenPath { at, length: new, seen }: UnseenPath,
    s: &WorldState<'_>,
) -> ControlFlow<Next, Box<PlanResult>> {
    if query.is_driving {
        return ControlFlow::Break(stop_for_path_in_view(tools, search, query, s));
    }
    if let Some(wait) = judge_detour(tools, search, new, s) {
        return ControlFlow::Break(Some(wait));
    }
    if let Some(change) = look_again(tools, search, s) {
        return ControlFlow::Break(Some(change));
    }
    search.rest_over_unseen_floor = Some(new);
    if search.seeks_view_of(at, &mut tools.planner, &mut tools.follower, s) {
        return ControlFlow::Break(observe(tools, search, at));
    }
    search.viewpoint = Default::default();
    match seen {
        Some(seen) => ControlFlow::Continue(seen),
        // The next plan avoids this floor.
        None if tools.planner.visibility.bar(at, s.now) => ControlFlow::Break(None),
        None => ControlFlow::Break(without_path(tools, search, NoPath::Blocked { nearest: at }, s)),
    }
}

/// Recovers by a view of the floor at a place.
fn observe(tools: &mut Tools, search: &mut PathSearch, at: Vector2) -> Next {
    if !search.is_going() {
        tools.follower.halt();
        tools.plan = None;
    }
    search.held_since = None;
    let (reason, search) = (Reason::UnseenFloor { at }, std::mem::take(search));
    State::Recover(Recover { reason, is_wedged: false, search }).because(TransitionReason::UnseenFloor)
}

/// Stops a drive whose path is not observed in time, until another plan exists.
fn stop_for_path_in_view(
    tools: &mut Tools,
    search: &mut PathSearch,
    query: &Query,
    s: &WorldState<'_>,
) -> Next {
    let why = (Reason::PathOutOfView, TransitionReason::PathOutOfView);
    if query.is_driving { hold(tools, search, why, s.now) } else { None }
}

/// Reaction to a missing path: stops, turns on the spot until the surroundings are observed, drives to a viewpoint of the blocked
/// place, and waits with the camera on that place.
fn without_path(tools: &mut Tools, search: &mut PathSearch, cause: NoPath, s: &WorldState<'_>) -> Next {
    if let Some(change) = look_again(tools, search, s) {
        return Some(change);
    }
    search.rest_over_unseen_floor = None;
    let is_final = is_final(tools, search, &cause, s.now);
    if search.is_going() {
        let (reason, search) = (tools.planner.no_path(cause), std::mem::take(search));
        let recover = Recover { reason, is_wedged: false, search };
        return State::Recover(recover).because(TransitionReason::NoPath);
    }
    let is_wedged = tools.body.is_polygon && matches!(cause, NoPath::StartInObstacle { .. });
    tools.follower.halt();
    tools.plan = None;
    search.blocked_at = match &cause {
        NoPath::Blocked { nearest } => Some(*nearest),
        _ => tools.goal.pose().map(|goal| goal.position()),
    };
    let reason = tools.planner.no_path(cause);
    let has_observed = search.spin.has_turned(MAX_SPINS) && !is_wedged;
    let state = if is_final {
        State::Stopped { reason }
    } else if has_observed && !search.seeks_viewpoint(&mut tools.planner, &mut tools.follower, s) {
        State::Wait(Wait { reason, search: std::mem::take(search), interrupted: None })
    } else {
        State::Recover(Recover { reason, is_wedged, search: std::mem::take(search) })
    };
    Some(Change { to: state, reason: TransitionReason::NoPath })
}

/// Whether the goal ends without a wait for a path. A viewpoint ends immediately; another goal that does not wait ends if no path
/// exists over known or unknown floor.
fn is_final(tools: &Tools, search: &mut PathSearch, cause: &NoPath, now: Stamp) -> bool {
    let since = *search.no_path_since.get_or_insert(now);
    let is_at_goal = !matches!(cause, NoPath::StartInObstacle { .. } | NoPath::StartOutside);
    // Floor kept out of the search may be observed later.
    let is_kept_out = tools.planner.visibility.keep_out().is_some();
    let is_proven = is_at_goal && !is_kept_out && now - since >= NO_PATH_CONFIRMATION_S;
    tools.goal.is_viewpoint() || tools.ends_without_path && !tools.waits_when_blocked() && is_proven
}

/// The drive to the final viewpoint before the goal is given up; `None` before it, and once the robot is there.
fn look_again(tools: &mut Tools, search: &mut PathSearch, s: &WorldState<'_>) -> Next {
    let nearest = tools.guard.final_observation().filter(|observation| !observation.is_there)?.nearest;
    search.blocked_at = Some(nearest);
    if !search.seeks_viewpoint(&mut tools.planner, &mut tools.follower, s) {
        tools.guard.arrived_at_final_viewpoint(s.now);
        search.viewpoint = Viewpoint::default();
        return None;
    }
    let (reason, search) = (tools.planner.no_path(NoPath::Blocked { nearest }), std::mem::take(search));
    State::Recover(Recover { reason, is_wedged: false, search }).because(TransitionReason::NoPath)
}

/// A new path of a length \[m\] that is longer than the one before it: the guard allows the detour, or the goal asks to wait.
fn judge_detour(tools: &mut Tools, search: &mut PathSearch, new: f64, s: &WorldState<'_>) -> Next {
    match detour(tools, new, s) {
        Detour::Refused(at) => return refuse_detour(tools, search, at, s.now),
        Detour::Taken => tools.guard.allow_detour(s.now, tools.planner.visibility.results()),
        Detour::None => {}
    }
    None
}

/// Waits before an obstacle on the path, with the camera on it, in place of a detour.
fn refuse_detour(tools: &mut Tools, search: &mut PathSearch, at: Vector2, now: Stamp) -> Next {
    tools.plan = None;
    search.blocked_at = Some(at);
    hold(tools, search, (Reason::PathBlocked { at }, TransitionReason::DetourRefused), now)
}

/// Stops, and waits.
fn hold(
    tools: &mut Tools,
    search: &mut PathSearch,
    (reason, why): (Reason, TransitionReason),
    now: Stamp,
) -> Next {
    tools.follower.halt();
    search.held_since.get_or_insert(now);
    State::Wait(Wait { reason, search: std::mem::take(search), interrupted: None }).because(why)
}

//! A path that has become longer: whether the robot takes the detour or waits.

use crate::behaviour::progress_checker::followed_path::FollowedPath;
use crate::behaviour::progress_checker::rest::length;
use crate::behaviour::tools::Tools;
use crate::world_state::WorldState;
use trundle_core::Vector2;

/// A new path compared with the one before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Detour {
    /// The new path is no longer than the shortest one so far, or no obstacle blocks the path before it.
    None,
    /// The new path is longer, because of an obstacle.
    Taken,
    /// The new path is much longer because of an obstacle on floor that was seen free, at this place, map frame \[m\], and the goal asks
    /// to wait.
    Refused(Vector2),
}

/// Length of a detour, as a multiple of the rest of the path before it, above which a goal that asks to wait waits. Source: ours.
const MAX_DETOUR_RATIO: f64 = 1.5;
/// Length that is allowed in addition \[m\]: the way around a person. Source: ours.
const MAX_DETOUR_EXTRA_M: f64 = 2.0;

/// Compares a new path of a length \[m\] with the one before it.
pub(super) fn detour(tools: &Tools, new: f64, s: &WorldState<'_>) -> Detour {
    if !tools.guard.is_longer(new, tools.planner.visibility.results()) {
        return Detour::None;
    }
    let Some(before) = tools.guard.path() else { return Detour::None };
    let obstacle = tools.planner.obstacle_on(&before.trajectory, before.time, s);
    let Some(obstacle) = obstacle else { return Detour::None };
    // A wall that was not in view yet does not leave.
    let is_new = before.was_free(obstacle.time, &obstacle.pose, tools.body.radius);
    if is_new && tools.waits_when_blocked() && is_much_longer(before, new, tools.body.radius) {
        return Detour::Refused(obstacle.pose.position());
    }
    Detour::Taken
}

/// Whether a new path of a length \[m\] is much longer than the rest of the path before it.
fn is_much_longer(before: &FollowedPath, new: f64, radius: f64) -> bool {
    new > MAX_DETOUR_RATIO * length(&before.trajectory, before.time, radius) + MAX_DETOUR_EXTRA_M
}

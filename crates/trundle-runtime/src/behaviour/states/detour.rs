//! A path that has become longer: whether the robot takes the detour or waits.

use crate::behaviour::progress::rest::length;
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
    /// The new path is much longer because of an obstacle at this place, map frame \[m\], and the goal asks to wait.
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
    let planner = &tools.planner;
    let before = tools.guard.path();
    let obstacle = before.and_then(|(path, time)| planner.obstacle_on(path, time, s));
    if let Some(at) = obstacle
        && tools.waits_when_blocked()
        && is_much_longer(tools, new)
    {
        return Detour::Refused(at);
    }
    if obstacle.is_some() { Detour::Taken } else { Detour::None }
}

/// Whether a new path is much longer than the rest of the path before it.
fn is_much_longer(tools: &Tools, new: f64) -> bool {
    tools.guard.path().is_some_and(|(path, time)| {
        new > MAX_DETOUR_RATIO * length(path, time, tools.body.radius) + MAX_DETOUR_EXTRA_M
    })
}

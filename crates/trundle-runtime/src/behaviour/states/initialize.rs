//! Initialize: at rest until the opening is over.

use crate::behaviour::path_search::PathSearch;
use crate::behaviour::state::{Next, State};
use crate::behaviour::tools::Tools;
use crate::reason::TransitionReason;
use crate::world_state::WorldState;

/// Begins to plan once the opening is over: the robot does not move before the first view.
pub(crate) fn prepare(tools: &mut Tools, s: &WorldState<'_>) -> Next {
    if !tools.opening.is_over(s) || tools.goal.pose().is_none() {
        return None;
    }
    tools.planner.visibility.home.get_or_insert(s.estimate.pose.position());
    State::Plan(PathSearch::default()).because(TransitionReason::Initialized)
}

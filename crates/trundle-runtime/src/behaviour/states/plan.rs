//! Plan: about to plan, at rest.

use super::replan::{Planned, Query, replan};
use crate::behaviour::path_search::PathSearch;
use crate::behaviour::tools::Tools;
use crate::stage::{Stage, StageTimes};
use crate::world_state::WorldState;
use trundle_core::Twist2;

/// Plans from the robot's pose.
pub(crate) fn plan(
    search: &mut PathSearch,
    tools: &mut Tools,
    s: &WorldState<'_>,
    times: &mut StageTimes,
) -> Planned {
    let Some(goal) = tools.goal.pose().filter(|_| tools.schedule.check_due.due(s.now)) else {
        return Planned::default();
    };
    let query = Query { goal, from: (s.estimate.pose, Twist2::ZERO), is_driving: false };
    times.measure(Stage::Planning, || replan(tools, search, &query, s))
}

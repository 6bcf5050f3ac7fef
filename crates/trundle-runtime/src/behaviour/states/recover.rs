//! Recover: observing more of the surroundings in search of a path.

use super::replan::{Planned, Query, replan};
use crate::behaviour::path_search::viewpoint::Viewpoint;
use crate::behaviour::state::{Next, Recover, State, Wait};
use crate::behaviour::tools::Tools;
use crate::reason::{Reason, TransitionReason};
use crate::stage::{Stage, StageTimes};
use crate::world_state::WorldState;
use trundle_control::{FollowReport, StopReason};
use trundle_core::{Pose2, Twist2};

/// Speed of backing out of a place with no room to turn \[m/s\]. Source: ours.
const REVERSE_SPEED_M_S: f64 = 0.1;

impl Recover {
    /// Plans to the goal as soon as the surroundings may show a path; else checks the path to the viewpoint.
    pub(crate) fn plan(&mut self, tools: &mut Tools, s: &WorldState<'_>, times: &mut StageTimes) -> Planned {
        let Some(goal) = tools.goal.pose().filter(|_| tools.schedule.check_due.due(s.now)) else {
            return Planned::default();
        };
        if !self.search.needs_new_plan(s) {
            self.search.watch_path_to_viewpoint(&mut tools.planner, &mut tools.follower, s);
            return Planned::default();
        }
        let query = Query { goal, from: self.start(tools, s), is_driving: false };
        times.measure(Stage::Planning, || replan(tools, &mut self.search, &query, s))
    }

    /// On the path to a viewpoint the plan starts from the reference.
    fn start(&self, tools: &Tools, s: &WorldState<'_>) -> (Pose2, Twist2) {
        match tools.follower.reference() {
            Some(reference) if self.search.is_going() => (reference.pose, reference.twist),
            _ => (s.estimate.pose, Twist2::ZERO),
        }
    }

    /// Observes at the end of the path to a viewpoint.
    pub(crate) fn on_follow(&mut self, tools: &mut Tools, follow: &FollowReport, s: &WorldState<'_>) -> Next {
        self.search.on_follow(&mut tools.planner, &mut tools.follower, follow, s.now);
        None
    }

    /// The command: out of a place with no room to turn, to a viewpoint, at rest at a viewpoint, else around on the spot.
    pub(crate) fn tick(&mut self, follow: &FollowReport, s: &WorldState<'_>) -> (Twist2, Next) {
        let twist = match self.search.viewpoint {
            _ if self.is_wedged => Twist2::new(-REVERSE_SPEED_M_S, 0.0),
            Viewpoint::Going(..) => follow.twist,
            Viewpoint::Looking(_) | Viewpoint::Choosing(..) => Twist2::ZERO,
            Viewpoint::Unknown | Viewpoint::Settled => self.search.spin.twist(s.estimate.pose),
        };
        (twist, None)
    }

    /// Ends the drive to a viewpoint.
    pub(crate) fn on_stop(&mut self, tools: &mut Tools, stop: StopReason, s: &WorldState<'_>) -> Next {
        if !self.search.is_going() {
            return None;
        }
        self.search.viewpoint = Viewpoint::Settled;
        self.search.held_since.get_or_insert(s.now);
        tools.follower.halt();
        let search = std::mem::take(&mut self.search);
        let wait = Wait { reason: Reason::Safety(stop), search, interrupted: None };
        State::Wait(wait).because(TransitionReason::SafetyStop)
    }
}

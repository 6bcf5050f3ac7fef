//! Requests to the navigator around a decision job.

use super::Navigator;
use crate::behaviour::state::State;
use crate::behaviour::tools::Tools;
use crate::workers::fallback_controller::FallbackController;
use crate::world_state::WorldState;
use trundle_core::{Stamp, Twist2};

/// Time before the end of the trajectory \[s\] from which the final approach may begin. Source: ours.
const APPROACH_LEAD_S: f64 = 0.1;

impl Navigator {
    /// Whether the next step may plan, search turns and straight moves, or check the rest of a path.
    pub(crate) fn may_take_long(&self, s: &WorldState<'_>) -> bool {
        let tools = &self.tools;
        if tools.goal.pose().is_none() {
            return false;
        }
        match self.machine.state() {
            State::Idle | State::Arrived | State::Stopped { .. } => false,
            State::Relocalize { .. } | State::Confirm(_) | State::Approach | State::Face(_) => false,
            State::Spin(_) | State::Relative(_) | State::Station(_) => false,
            State::Maneuver | State::Initialize | State::Plan(_) => true,
            _ if tools.planner.has_other_zones(s) => true,
            State::Recover(_) | State::Wait(_) => is_check_due(tools, s.now),
            State::Drive(_) => is_check_due(tools, s.now) || is_nearly_there(tools),
        }
    }

    /// The controller that continues the last decision.
    pub(crate) fn fallback(&self) -> FallbackController {
        let follows = match self.machine.state() {
            State::Drive(_) | State::Approach => true,
            State::Recover(recover) => recover.search.is_going(),
            _ => false,
        };
        FallbackController {
            follower: self.tools.follower.clone(),
            safety: self.safety.clone(),
            wanted: (!follows).then_some(self.wanted),
            touched: self.tools.contacts.touched,
            over_edge: self.tools.contacts.over_edge,
            sent: Twist2::ZERO,
        }
    }

    /// Records the twist that left during a decision job.
    pub(crate) fn sent(&mut self, twist: Twist2) {
        self.tools.follower.sent(twist);
    }
}

fn is_check_due(tools: &Tools, now: Stamp) -> bool {
    tools.schedule.check_due.will_be_due(now) || tools.schedule.improve_due.will_be_due(now)
}

fn is_nearly_there(tools: &Tools) -> bool {
    let left = tools.plan.as_ref().zip(tools.follower.reference());
    left.is_none_or(|(plan, reference)| plan.result.trajectory.duration() - reference.time < APPROACH_LEAD_S)
}

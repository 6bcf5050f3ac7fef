//! Requests to the navigator around a decision job.

use super::{Goal, Navigator, viewpoint::Viewpoint};
use crate::world_state::WorldState;
use crate::{behaviour::drive_state::DriveState, workers::fallback_controller::FallbackController};
use trundle_core::{Stamp, Twist2};

/// Time before the end of the trajectory \[s\] from which the final approach may begin. Source: ours.
const APPROACH_LEAD_S: f64 = 0.1;

impl Navigator {
    /// Whether the next step may plan, search turns and straight moves, or check the rest of a path.
    pub(crate) fn may_take_long(&self, s: &WorldState<'_>) -> bool {
        if self.goal.pose().is_none() {
            return false;
        }
        match self.state() {
            DriveState::Idle | DriveState::Arrived | DriveState::Stopped { .. } => false,
            DriveState::Lost { .. } | DriveState::FinalApproach => false,
            DriveState::Maneuvering => true,
            DriveState::Initializing | DriveState::Planning => true,
            _ if self.has_other_zones(s) => true,
            DriveState::Recovering { .. } | DriveState::Waiting { .. } => self.is_check_due(s.now),
            DriveState::Driving => self.is_check_due(s.now) || self.is_nearly_there(),
        }
    }

    fn is_check_due(&self, now: Stamp) -> bool {
        self.check_due.will_be_due(now) || self.improve_due.will_be_due(now)
    }

    fn is_nearly_there(&self) -> bool {
        let left = self.plan.as_ref().zip(self.follower.reference());
        left.is_none_or(|(plan, reference)| plan.trajectory.duration() - reference.time < APPROACH_LEAD_S)
    }

    /// The controller that continues the last decision.
    pub(crate) fn fallback(&self) -> FallbackController {
        let follows = match self.state() {
            DriveState::Driving => true,
            DriveState::Recovering { .. } => matches!(self.viewpoint, Viewpoint::Going(..)),
            DriveState::FinalApproach => !matches!(self.goal, Goal::Viewpoint(_)),
            _ => false,
        };
        FallbackController {
            follower: self.follower.clone(),
            safety: self.safety.clone(),
            wanted: (!follows).then_some(self.wanted),
            touched: self.touched,
            over_edge: self.over_edge,
            sent: Twist2::ZERO,
        }
    }

    /// Records the twist that left during a decision job.
    pub(crate) fn sent(&mut self, twist: Twist2) {
        self.follower.sent(twist);
    }
}

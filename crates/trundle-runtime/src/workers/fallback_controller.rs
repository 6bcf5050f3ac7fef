//! The fallback controller: controls the robot while a decision job runs.

use crate::behaviour::navigator::safety_input;
use crate::world_state::WorldState;
use trundle_control::{Follower, SafetyMonitor};
use trundle_core::Twist2;

/// Continues the last decision during a decision job: along the trajectory, or with the last twist. The safety monitor checks each twist.
#[derive(Debug)]
pub(crate) struct FallbackController {
    pub(crate) follower: Follower,
    pub(crate) safety: SafetyMonitor,
    /// Twist of the last decision; `None` for the path follower's twist.
    pub(crate) wanted: Option<Twist2>,
    pub(crate) touched: bool,
    pub(crate) over_edge: bool,
    /// The last commanded twist.
    pub(crate) sent: Twist2,
}

impl FallbackController {
    /// Drops the trajectory or the last twist: the robot brakes to rest within its limits.
    pub(crate) fn halt(&mut self) {
        self.follower.halt();
        self.wanted = None;
    }

    /// One control step.
    pub(crate) fn step(&mut self, s: &WorldState<'_>) -> Twist2 {
        let follow = self.follower.step(&s.estimate, s.now);
        let wanted = self.wanted.unwrap_or(follow.twist);
        let report = self.safety.check(&safety_input(s, wanted, self.touched, self.over_edge));
        self.follower.sent(report.twist);
        self.sent = report.twist;
        report.twist
    }
}

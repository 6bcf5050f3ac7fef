//! Relative: a motion relative to the robot's pose.

use crate::behaviour::relative_motion::{RelativeMotion, RelativeMotionDrive};
use crate::behaviour::state::{Next, Relative, State};
use crate::behaviour::tools::Tools;
use crate::reason::{Reason, TransitionReason};
use crate::world_state::WorldState;
use trundle_control::SafetyAction;
use trundle_core::Twist2;

impl Relative {
    pub(crate) fn new(motion: RelativeMotion) -> Self {
        Self { motion, drive: RelativeMotionDrive::default() }
    }

    /// One control step.
    pub(crate) fn tick(&mut self, tools: &Tools, s: &WorldState<'_>) -> (Twist2, Next) {
        if !tools.opening.is_rested(s) {
            return (Twist2::ZERO, None);
        }
        match self.drive.step(self.motion, s.estimate.pose) {
            Some(twist) => (twist, None),
            None => (Twist2::ZERO, State::Arrived.because(TransitionReason::GoalReached)),
        }
    }

    /// Ends a motion that the safety monitor has stopped for too long. A hold by the body does not count.
    pub(crate) fn on_safety(&mut self, action: SafetyAction, s: &WorldState<'_>) -> Next {
        let stop = match action {
            SafetyAction::Stop(reason) if s.hold.is_none() => Some(reason),
            _ => None,
        };
        let is_blocked = self.drive.is_blocked(stop.is_some(), s.now);
        let reason = Reason::Safety(stop.filter(|_| is_blocked)?);
        State::Stopped { reason }.because(TransitionReason::MotionFailed)
    }
}

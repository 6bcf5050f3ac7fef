//! Station: a motion at a charging station.

use crate::behaviour::state::{Next, State, Station};
use crate::behaviour::station_drive::{StationDrive, StationGoal, StationProgress};
use crate::behaviour::tools::Tools;
use crate::reason::{Reason, TransitionReason};
use crate::world_state::WorldState;
use trundle_control::StationMotion;
use trundle_core::Twist2;

impl Station {
    pub(crate) fn new(goal: StationGoal) -> Self {
        Self { goal, drive: StationDrive::default() }
    }

    /// One control step.
    pub(crate) fn tick(&mut self, tools: &Tools, s: &WorldState<'_>) -> (Twist2, Next) {
        if !tools.opening.is_rested(s) {
            return (Twist2::ZERO, None);
        }
        match self.drive.step(&self.goal, s, tools.contacts.touched, tools.body.reach) {
            StationProgress::Moving(twist) => (twist, None),
            StationProgress::Done => (Twist2::ZERO, State::Arrived.because(TransitionReason::GoalReached)),
            StationProgress::Failed(failure) => {
                let reason = Reason::Docking(failure);
                (Twist2::ZERO, State::Stopped { reason }.because(TransitionReason::MotionFailed))
            }
        }
    }

    /// The motion that the safety monitor shall permit.
    pub(crate) fn permission(&self, s: &WorldState<'_>) -> Option<StationMotion> {
        self.drive.permission(&self.goal, s.estimate.pose)
    }
}

//! The one place where the robot's state changes.

use super::drive_state::DriveState;
use super::transitions::{StateKind, is_allowed};
use crate::reason::TransitionReason;

/// Holds the state. [`StateMachine::change`] checks each change against the table of transitions.
#[derive(Debug, Default)]
pub(crate) struct StateMachine {
    state: DriveState,
}

impl StateMachine {
    /// The present state.
    pub(crate) fn state(&self) -> &DriveState {
        &self.state
    }

    /// Changes the state. A change that the table lacks is an error of this program: it is logged, and a debug build stops.
    pub(crate) fn change(&mut self, to: DriveState, reason: TransitionReason) {
        let kinds = (kind_of(&self.state), kind_of(&to));
        let is_known = is_allowed(kinds.0, reason, kinds.1);
        if !is_known {
            tracing::error!(
                "state change {:?} -> {:?}, {reason:?}: not in the table of transitions",
                kinds.0,
                kinds.1
            );
        }
        debug_assert!(is_known, "invariant: {kinds:?}, {reason:?} is in the table of transitions");
        tracing::debug!("{} -> {to}: {reason}", self.state.name());
        self.state = to;
    }

    /// Sets a state for a test.
    #[cfg(test)]
    pub(crate) fn place(&mut self, state: DriveState) {
        self.state = state;
    }
}

fn kind_of(state: &DriveState) -> StateKind {
    match state {
        DriveState::Idle => StateKind::Idle,
        DriveState::Initializing => StateKind::Initializing,
        DriveState::Planning => StateKind::Planning,
        DriveState::Driving => StateKind::Driving,
        DriveState::FinalApproach => StateKind::FinalApproach,
        DriveState::Maneuvering => StateKind::Maneuvering,
        DriveState::Waiting { .. } => StateKind::Waiting,
        DriveState::Recovering { .. } => StateKind::Recovering,
        DriveState::Lost { .. } => StateKind::Lost,
        DriveState::Arrived => StateKind::Arrived,
        DriveState::Stopped { .. } => StateKind::Stopped,
    }
}

//! The states of the robot.

use crate::reason::{Reason, TransitionReason};
use serde::{Deserialize, Serialize};
use std::fmt;

/// State of the robot as front ends show it; states without progress carry a reason.
///
/// Several states of the state machine may show as one. `docs/explanation/behaviour.md` has the diagram of the state machine and the
/// table of its transitions.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum DriveState {
    /// No goal.
    #[default]
    Idle,
    /// Observing the surroundings: at rest until the first scan is in the grid, or turning on the spot.
    Initializing,
    /// About to plan.
    Planning,
    /// Following a trajectory.
    Driving,
    /// The robot is near the goal: point stabilisation onto the exact pose.
    FinalApproach,
    /// Near the goal in a narrow space: turns on the spot and straight moves onto the exact pose.
    Maneuvering,
    /// The safety monitor stops the robot, or no path is free.
    Waiting {
        /// Reason for the wait.
        reason: Reason,
    },
    /// No free path is known: observing more of the surroundings.
    Recovering {
        /// The planner's result.
        reason: Reason,
    },
    /// Pose unknown or too uncertain: at rest, then turning on the spot to relocalise.
    Lost {
        /// State of the pose estimate.
        reason: Reason,
    },
    /// The robot is at rest at the goal.
    Arrived,
    /// The goal is abandoned.
    Stopped {
        /// Reason for the end.
        reason: Reason,
    },
}

impl DriveState {
    /// The state in one or two words.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Idle => "idle",
            Self::Initializing => "initializing",
            Self::Planning => "planning",
            Self::Driving => "driving",
            Self::FinalApproach => "final approach",
            Self::Maneuvering => "maneuvering",
            Self::Waiting { .. } => "waiting",
            Self::Recovering { .. } => "recovering",
            Self::Lost { .. } => "lost",
            Self::Arrived => "arrived",
            Self::Stopped { .. } => "stopped",
        }
    }

    /// Reason why the robot makes no progress; `None` in a state without a reason.
    pub fn reason(&self) -> Option<&Reason> {
        match self {
            Self::Waiting { reason }
            | Self::Recovering { reason }
            | Self::Lost { reason }
            | Self::Stopped { reason } => Some(reason),
            _ => None,
        }
    }

    /// The state with its reason; a state without a reason with the reason for the change to it.
    #[must_use]
    pub fn explained(&self, transition: Option<TransitionReason>) -> String {
        match transition.filter(|_| self.reason().is_none()) {
            Some(transition) => format!("{self}: {transition}"),
            None => self.to_string(),
        }
    }

    /// Whether the navigator is done with its goal.
    pub fn is_over(&self) -> bool {
        matches!(self, Self::Idle | Self::Arrived | Self::Stopped { .. })
    }
}

impl fmt::Display for DriveState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.reason() {
            Some(reason) => write!(f, "{}: {reason}", self.name()),
            None => f.write_str(self.name()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// Every state.
    fn states() -> [DriveState; 11] {
        let reason = Reason::MovingObstacle;
        [
            DriveState::Idle,
            DriveState::Initializing,
            DriveState::Planning,
            DriveState::Driving,
            DriveState::FinalApproach,
            DriveState::Maneuvering,
            DriveState::Waiting { reason: reason.clone() },
            DriveState::Recovering { reason: reason.clone() },
            DriveState::Lost { reason: reason.clone() },
            DriveState::Arrived,
            DriveState::Stopped { reason },
        ]
    }

    #[test]
    fn each_state_has_a_name_of_its_own() {
        let names: BTreeSet<_> = states().iter().map(DriveState::name).collect();
        assert_eq!(names.len(), states().len());
    }

    #[test]
    fn a_state_with_a_reason_shows_it_and_another_is_its_name() {
        for state in states() {
            let expected = match state.reason() {
                Some(reason) => format!("{}: {reason}", state.name()),
                None => state.name().to_owned(),
            };
            assert_eq!(state.to_string(), expected);
        }
        assert_eq!(states().iter().filter(|state| state.reason().is_some()).count(), 4);
    }

    #[test]
    fn three_states_need_a_new_goal() {
        let over: Vec<_> = states().iter().filter(|state| state.is_over()).map(DriveState::name).collect();
        assert_eq!(over, ["idle", "arrived", "stopped"]);
        assert_eq!(DriveState::default(), DriveState::Idle);
    }
}

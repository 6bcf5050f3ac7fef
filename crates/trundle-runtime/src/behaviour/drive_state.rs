//! The states of the robot.

use crate::reason::Reason;
use std::fmt;

/// State of the robot, with the reason where the robot does not move on.
///
/// From any state a new goal leads to `Initializing` (before the first plan) or `Planning`, a stop by the safety monitor to
/// `Waiting`, and an estimate that is too unsure to `Lost`.
///
/// | state | leads to |
/// |---|---|
/// | idle | initializing, planning |
/// | initializing | planning; arrived, when the goal is a turn on the spot |
/// | planning | driving, maneuvering, recovering |
/// | driving | final approach, maneuvering, planning, waiting |
/// | final approach, maneuvering | arrived, waiting, stopped |
/// | waiting | driving, planning, maneuvering, stopped |
/// | recovering | driving, waiting |
/// | lost | initializing, stopped |
/// | arrived, stopped | initializing, with the next goal |
#[derive(Debug, Clone, PartialEq, Default)]
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
    /// Near the goal: point stabilisation onto the exact pose.
    FinalApproach,
    /// Near the goal in a narrow space: turns on the spot and straight moves onto the exact pose.
    Maneuvering,
    /// Held by the safety monitor, or until a path is free.
    Waiting {
        /// What the robot waits for.
        reason: Reason,
    },
    /// No free path is known: observing more of the surroundings.
    Recovering {
        /// What the planner reports.
        reason: Reason,
    },
    /// Pose unknown or too uncertain: at rest, then turning on the spot to relocalise.
    Lost {
        /// What is known of the pose.
        reason: Reason,
    },
    /// At rest at the goal.
    Arrived,
    /// The goal is given up.
    Stopped {
        /// Why.
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

    /// Why the robot does not move on; none in a state without a reason.
    pub fn reason(&self) -> Option<&Reason> {
        match self {
            Self::Waiting { reason }
            | Self::Recovering { reason }
            | Self::Lost { reason }
            | Self::Stopped { reason } => Some(reason),
            _ => None,
        }
    }

    /// Whether the navigator has nothing left to do for its goal.
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

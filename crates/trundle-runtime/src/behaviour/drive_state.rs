//! The states of the robot.

use std::fmt;

/// What the robot is doing, and why where it is not moving on.
///
/// From any state a new goal leads to `Initializing` (before the first plan) or `Planning`, a stop by the safety monitor to
/// `Waiting`, and an estimate that is too unsure to `Lost`.
///
/// | state | leads to |
/// |---|---|
/// | idle | planning, mapping |
/// | mapping | planning; arrived, when only looking around was asked for |
/// | planning | driving, docking, recovering |
/// | driving | settling, docking, planning, waiting |
/// | settling, docking | arrived, waiting, stopped |
/// | waiting | driving, planning, docking, stopped |
/// | recovering | driving, waiting |
/// | lost | planning, stopped |
/// | arrived, stopped | the next goal's |
#[derive(Debug, Clone, PartialEq, Default)]
pub enum DriveState {
    /// No goal.
    #[default]
    Idle,
    /// Seeing the surroundings: standing until the first view is drawn, or turning on the spot.
    Initializing,
    /// About to plan.
    Planning,
    /// On its way along a trajectory.
    Driving,
    /// Near the goal: taking up the exact pose.
    FinalApproach,
    /// Near the goal where it is tight: taking up the exact pose by turns on the spot and straight moves.
    Maneuvering,
    /// Held by the safety monitor, or until a way is free.
    Waiting {
        /// For what.
        reason: String,
    },
    /// No free way is known: turning on the spot to see more.
    Recovering {
        /// What the planner said.
        reason: String,
    },
    /// Not knowing where it is: standing, then turning on the spot to recognise something.
    Lost {
        /// How unsure it is.
        reason: String,
    },
    /// At the goal, standing.
    Arrived,
    /// Given up.
    Stopped {
        /// Why.
        reason: String,
    },
}

impl DriveState {
    /// One word.
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

    /// Why it does not move on, where it does not.
    pub fn reason(&self) -> Option<&str> {
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

use std::fmt;

/// What the robot is doing, and why where it is not moving on.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum DriveState {
    /// No goal.
    #[default]
    Idle,
    /// Waiting for the first view of the surroundings.
    Opening,
    /// On its way along a trajectory.
    Driving,
    /// Near the goal: taking up the exact pose.
    Settling,
    /// Near the goal where it is tight: taking up the exact pose by turns on the spot and straight moves.
    Docking,
    /// No free way is known: turning to see more.
    Looking {
        /// What the planner said.
        reason: String,
    },
    /// Held by the safety monitor, for the moment.
    Held {
        /// What it said.
        reason: String,
    },
    /// On the goal pose, standing.
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
            Self::Opening => "opening",
            Self::Driving => "driving",
            Self::Settling => "settling",
            Self::Docking => "docking",
            Self::Looking { .. } => "looking",
            Self::Held { .. } => "held",
            Self::Arrived => "arrived",
            Self::Stopped { .. } => "stopped",
        }
    }
}

impl fmt::Display for DriveState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Looking { reason } | Self::Held { reason } | Self::Stopped { reason } => {
                write!(f, "{}: {reason}", self.name())
            }
            _ => f.write_str(self.name()),
        }
    }
}

//! Goals of the navigator.

use super::relative_motion::RelativeMotion;
use super::station_drive::StationGoal;
use trundle_core::Pose2;

/// Goal of the robot, map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Goal {
    /// Stand exactly here.
    Exact(Pose2),
    /// A viewpoint: the robot need not reach it exactly, and skips it if it is blocked.
    Viewpoint(Pose2),
    /// Turns and straight moves onto this pose from near by.
    Align(Pose2),
    /// A motion at a charging station.
    Station(StationGoal),
    /// A motion relative to the robot's present pose.
    Relative(RelativeMotion),
    /// Turn on the spot once.
    Spin,
    /// Stay at the present pose.
    Stay,
}

impl Goal {
    /// The pose of the goal; `None` for a motion.
    pub(crate) fn pose(self) -> Option<Pose2> {
        match self {
            Self::Exact(pose) | Self::Viewpoint(pose) | Self::Align(pose) => Some(pose),
            Self::Station(_) | Self::Relative(_) | Self::Spin | Self::Stay => None,
        }
    }

    /// Whether the robot can roll on to this goal from the path to another one.
    pub(crate) fn is_driven_to(self) -> bool {
        matches!(self, Self::Exact(_) | Self::Viewpoint(_))
    }

    /// Whether the goal is a viewpoint.
    pub(crate) fn is_viewpoint(self) -> bool {
        matches!(self, Self::Viewpoint(_))
    }
}

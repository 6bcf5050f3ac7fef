//! Reasons for the changes of the robot's state.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The reason for a change of the robot's state. The documentation of each variant is its text in the table of transitions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum TransitionReason {
    /// The mission executor gives a goal.
    GoalGiven,
    /// The mission executor takes the goal away.
    GoalDropped,
    /// The robot has stood for the time of the opening, and a scan exists.
    Initialized,
    /// The planner finds a path to the goal that the camera observes in time.
    PlanFound,
    /// The new plan starts from rest, and the robot moves.
    StoppingToReplan,
    /// A dynamic obstacle blocks the only path.
    MovingObstacle,
    /// The rest of the path crosses floor that the camera does not observe in time.
    PathOutOfView,
    /// The path crosses floor that was never observed; a viewpoint of this floor exists.
    UnseenFloor,
    /// An obstacle blocks the path, and the goal asks to wait in place of a detour.
    DetourRefused,
    /// The planner finds no path.
    NoPath,
    /// The safety monitor stops the robot.
    SafetyStop,
    /// The safety monitor lets the robot move on along its trajectory.
    SafetyPass,
    /// The trajectory ends.
    TrajectoryEnd,
    /// Turns and straight moves replace an arc or a path near the goal.
    ManeuverChosen,
    /// The robot is at rest at its goal, or its motion is complete.
    GoalReached,
    /// The robot is at its goal by its estimate, which is too uncertain for the goal.
    ArrivalUncertain,
    /// The pose at the goal is certain enough again.
    PoseConfirmed,
    /// Turns and straight moves, a motion at a charging station or a relative motion fails.
    MotionFailed,
    /// The bumper was pressed too often on the path to one goal.
    RepeatedContact,
    /// The camera repeatedly loses its view on the path to a viewpoint.
    NoSightOnPath,
    /// The robot makes no progress within the patience.
    NoProgress,
    /// The pose is unknown or too uncertain.
    PoseLost,
    /// The pose is known again.
    PoseFound,
}

impl fmt::Display for TransitionReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::GoalGiven => "a goal is given",
            Self::GoalDropped => "the goal is taken away",
            Self::Initialized => "the surroundings are in view",
            Self::PlanFound => "a path is found",
            Self::StoppingToReplan => "the new plan starts from rest",
            Self::MovingObstacle => "a moving obstacle blocks the path",
            Self::PathOutOfView => "the path leaves the camera's view",
            Self::UnseenFloor => "the path crosses unseen floor",
            Self::DetourRefused => "a detour is refused",
            Self::NoPath => "no path is found",
            Self::SafetyStop => "the safety monitor stops the robot",
            Self::SafetyPass => "the safety monitor lets the robot move on",
            Self::TrajectoryEnd => "the trajectory ends",
            Self::ManeuverChosen => "turns and straight moves are chosen",
            Self::GoalReached => "the goal is reached",
            Self::ArrivalUncertain => "the pose is too uncertain for the goal",
            Self::PoseConfirmed => "the pose is certain enough again",
            Self::MotionFailed => "the motion fails",
            Self::RepeatedContact => "the bumper was pressed too often",
            Self::NoSightOnPath => "the camera view is lost repeatedly",
            Self::NoProgress => "the robot makes no progress",
            Self::PoseLost => "the pose is lost",
            Self::PoseFound => "the pose is known again",
        })
    }
}

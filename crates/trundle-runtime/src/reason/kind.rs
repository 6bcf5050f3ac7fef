//! The kinds of reasons, for decisions by programs.

use super::no_path::NoPath;
use crate::mission::dock_failure::DockFailure;
use serde::{Deserialize, Serialize};
use trundle_control::{MotionHold, StopReason};

/// The kind of a reason, without its numbers. Its name in files is the name of the variant in `snake_case`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ReasonKind {
    /// An obstacle is within the braking distance.
    Obstacle,
    /// The bumper is pressed.
    Contact,
    /// A cliff sensor reports no floor.
    Cliff,
    /// No image or scan with content is recent enough.
    ImageMissing,
    /// Neither wheels nor images measure the robot's motion.
    MotionUnknown,
    /// No wheel reading is recent enough.
    WheelsMissing,
    /// A command is not a number.
    CommandInvalid,
    /// A wheel has dropped.
    WheelDrop,
    /// A wheel motor draws too much current.
    OverCurrent,
    /// A power supply is plugged in.
    AdapterConnected,
    /// The base, the camera or the laser does not answer.
    DeviceLost,
    /// The battery is empty.
    BatteryEmpty,
    /// A person paused the robot.
    Paused,
    /// The link by which goals come has died.
    GoalLinkLost,
    /// The robot stops before the next plan.
    StoppingToReplan,
    /// A dynamic obstacle blocks the path.
    MovingObstacle,
    /// Another path is searched that the camera shows in time.
    PathOutOfView,
    /// Unobserved floor on the path is observed first.
    UnseenFloor,
    /// Obstacles block the path.
    PathBlocked,
    /// The footprint does not fit at the start or at the goal.
    TooLittleRoom,
    /// The goal is in a no-go zone.
    NoGoZone,
    /// Start or goal is off the map.
    OffTheMap,
    /// The planner refuses the query.
    PlanRefused,
    /// The pose is unknown.
    PoseUnknown,
    /// The position is too uncertain.
    PoseUncertain,
    /// The pose at the goal is too uncertain for the goal.
    ArrivalUncertain,
    /// The position is too uncertain, and the wheels do not respond.
    WheelsUnresponsive,
    /// The bumper was pressed too often.
    RepeatedContact,
    /// The camera is blind on the path to a viewpoint.
    NoSightOnPath,
    /// No progress.
    NoProgress,
    /// The final approach fails.
    FinalApproach,
    /// No light of a charging station was detected.
    NoStationLight,
    /// The light of the charging station was lost.
    StationLightLost,
    /// The axis of the charging station is too uncertain.
    StationUncertain,
    /// Nothing charges at the charging station.
    NoCharging,
    /// An obstacle stops the straight move at the charging station.
    StationBlocked,
    /// Tasks of the mission failed.
    TasksFailed,
    /// The user ended the run.
    Interrupted,
    /// A kind from a file that is missing or unknown to this version.
    #[serde(other)]
    Unknown,
}

impl ReasonKind {
    /// The kind of a stop by the safety monitor.
    pub(super) fn of_stop(stop: &StopReason) -> Self {
        match stop {
            StopReason::ObstacleAhead { .. } | StopReason::ObstacleBeside { .. } => Self::Obstacle,
            StopReason::Touched => Self::Contact,
            StopReason::Cliff => Self::Cliff,
            StopReason::NoImage | StopReason::NothingSeen | StopReason::StaleImage { .. } => {
                Self::ImageMissing
            }
            StopReason::NothingTellsMotion => Self::MotionUnknown,
            StopReason::NoWheels | StopReason::StaleWheels { .. } => Self::WheelsMissing,
            StopReason::Held(hold) => Self::of_hold(hold),
            StopReason::NotFinite => Self::CommandInvalid,
            _ => Self::Unknown,
        }
    }

    /// Whether the floor of the path was not observed, or leaves the camera's view.
    pub(crate) fn is_unseen_path(self) -> bool {
        matches!(self, Self::UnseenFloor | Self::PathOutOfView)
    }

    /// Whether an obstacle blocks the path.
    pub(crate) fn is_blockage(self) -> bool {
        matches!(self, Self::Obstacle | Self::MovingObstacle | Self::PathBlocked)
    }

    /// The kind of a failure at the charging station.
    pub(super) fn of_docking(failure: DockFailure) -> Self {
        match failure {
            DockFailure::NoLight => Self::NoStationLight,
            DockFailure::LightLost => Self::StationLightLost,
            DockFailure::AxisUncertain { .. } => Self::StationUncertain,
            DockFailure::NoCharging { .. } => Self::NoCharging,
            DockFailure::Held => Self::StationBlocked,
        }
    }

    /// The kind of a hold by the body.
    fn of_hold(hold: &MotionHold) -> Self {
        match hold {
            MotionHold::WheelDrop => Self::WheelDrop,
            MotionHold::OverCurrent => Self::OverCurrent,
            MotionHold::AdapterConnected => Self::AdapterConnected,
            MotionHold::DeviceLost(_) => Self::DeviceLost,
            MotionHold::BatteryEmpty => Self::BatteryEmpty,
            MotionHold::Paused => Self::Paused,
            MotionHold::GoalLinkLost => Self::GoalLinkLost,
            _ => Self::Unknown,
        }
    }

    /// The kind of a failed search for a path.
    pub(super) fn of_no_path(cause: &NoPath) -> Self {
        match cause {
            NoPath::Blocked { .. } => Self::PathBlocked,
            NoPath::StartInObstacle { .. } | NoPath::GoalInObstacle { .. } => Self::TooLittleRoom,
            NoPath::GoalInZone { .. } => Self::NoGoZone,
            NoPath::StartOutside | NoPath::GoalOutside => Self::OffTheMap,
            NoPath::Refused(_) => Self::PlanRefused,
        }
    }
}

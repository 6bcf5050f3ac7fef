//! The states with their data.

use super::drive_state::DriveState;
use super::path_search::PathSearch;
use super::relative_motion::{RelativeMotion, RelativeMotionDrive};
use super::spin::Spin;
use super::station_drive::{StationDrive, StationGoal};
use super::transitions::StateKind;
use crate::reason::{Reason, TransitionReason};

/// A state with its data.
#[derive(Debug, Clone, Default)]
pub(crate) enum State {
    /// No goal.
    #[default]
    Idle,
    /// The robot is at rest until the opening is over.
    Initialize,
    /// One turn on the spot that observes the surroundings.
    Spin(Spin),
    /// About to plan.
    Plan(PathSearch),
    /// Following a trajectory.
    Drive(Drive),
    /// Point stabilisation onto the exact goal.
    Approach,
    /// A turn on the spot to the heading of a viewpoint, rad.
    Face(f64),
    /// At the goal by an uncertain pose: a turn on the spot to observe the surroundings.
    Confirm(Confirm),
    /// Turns and straight moves onto the exact goal.
    Maneuver,
    /// A motion relative to the robot's pose.
    Relative(Relative),
    /// A motion at a charging station.
    Station(Station),
    /// The robot is at rest until the path is free.
    Wait(Wait),
    /// Observing more of the surroundings in search of a path.
    Recover(Recover),
    /// Observing the surroundings in search of the pose.
    Relocalize {
        reason: Reason,
    },
    Arrived,
    Stopped {
        reason: Reason,
    },
}

/// A drive along a trajectory.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Drive {
    /// Whether the robot is too far from its reference to continue from it.
    pub(crate) is_off_track: bool,
}

/// A wait.
#[derive(Debug, Clone)]
pub(crate) struct Wait {
    pub(crate) reason: Reason,
    pub(crate) search: PathSearch,
    /// The drive that continues once the safety monitor permits it; `None` if the trajectory was dropped.
    pub(crate) interrupted: Option<Drive>,
}

/// An observation at the goal, because the pose is uncertain.
#[derive(Debug, Clone)]
pub(crate) struct Confirm {
    pub(crate) reason: Reason,
    pub(crate) spin: Spin,
}

/// A recovery from a missing path.
#[derive(Debug, Clone)]
pub(crate) struct Recover {
    pub(crate) reason: Reason,
    /// Whether the outline is too near to an obstacle for a turn: the robot backs out, as far as safety permits.
    pub(crate) is_wedged: bool,
    pub(crate) search: PathSearch,
}

/// A motion relative to the robot's pose.
#[derive(Debug, Clone)]
pub(crate) struct Relative {
    pub(crate) motion: RelativeMotion,
    pub(crate) drive: RelativeMotionDrive,
}

/// A motion at a charging station.
#[derive(Debug, Clone)]
pub(crate) struct Station {
    pub(crate) goal: StationGoal,
    pub(crate) drive: StationDrive,
}

/// A change of state.
#[derive(Debug)]
pub(crate) struct Change {
    pub(crate) to: State,
    pub(crate) reason: TransitionReason,
}

/// The change that a state requests; `None`: the state continues.
pub(crate) type Next = Option<Change>;

impl State {
    /// The request to change to this state.
    pub(crate) fn because(self, reason: TransitionReason) -> Next {
        Some(Change { to: self, reason })
    }

    /// The state without its data.
    pub(crate) fn kind(&self) -> StateKind {
        match self {
            Self::Idle => StateKind::Idle,
            Self::Initialize => StateKind::Initialize,
            Self::Spin(_) => StateKind::Spin,
            Self::Plan(_) => StateKind::Plan,
            Self::Drive(_) => StateKind::Drive,
            Self::Approach => StateKind::Approach,
            Self::Face(_) => StateKind::Face,
            Self::Confirm(_) => StateKind::Confirm,
            Self::Maneuver => StateKind::Maneuver,
            Self::Relative(_) => StateKind::Relative,
            Self::Station(_) => StateKind::Station,
            Self::Wait(_) => StateKind::Wait,
            Self::Recover(_) => StateKind::Recover,
            Self::Relocalize { .. } => StateKind::Relocalize,
            Self::Arrived => StateKind::Arrived,
            Self::Stopped { .. } => StateKind::Stopped,
        }
    }

    /// The state as front ends show it.
    pub(crate) fn published(&self) -> DriveState {
        match self {
            Self::Idle => DriveState::Idle,
            Self::Initialize | Self::Spin(_) => DriveState::Initializing,
            Self::Plan(_) => DriveState::Planning,
            Self::Drive(_) => DriveState::Driving,
            Self::Approach | Self::Face(_) => DriveState::FinalApproach,
            Self::Maneuver | Self::Relative(_) | Self::Station(_) => DriveState::Maneuvering,
            Self::Wait(Wait { reason, .. }) => DriveState::Waiting { reason: reason.clone() },
            Self::Recover(Recover { reason, .. }) => DriveState::Recovering { reason: reason.clone() },
            Self::Confirm(Confirm { reason, .. }) => DriveState::Recovering { reason: reason.clone() },
            Self::Relocalize { reason } => DriveState::Lost { reason: reason.clone() },
            Self::Arrived => DriveState::Arrived,
            Self::Stopped { reason } => DriveState::Stopped { reason: reason.clone() },
        }
    }
}

//! Reasons for stops of the robot and for incomplete tasks.

mod kind;
mod no_path;
mod recorded;
mod transition;

use crate::goal_approach::ApproachFailure;
use crate::mission::dock_failure::DockFailure;
use crate::mission::task::Task;
pub use kind::ReasonKind;
pub use no_path::NoPath;
use recorded::RecordedReason;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
pub use transition::TransitionReason;
use trundle_control::{SlowReason, StopReason};
use trundle_core::{PoseBound, Vector2};

/// The reason for a stop of the robot, or for an incomplete task. `Display` gives the reason in words.
///
/// In files a reason is its text (`reason`) and the names of its kinds (`kinds`). A reason read from a file keeps both, as
/// [`Reason::Restored`].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// The safety monitor stops the robot.
    Safety(StopReason),
    /// The robot stops, because the new plan starts from rest.
    StoppingToReplan,
    /// A dynamic obstacle blocks the only path.
    MovingObstacle,
    /// The path crosses floor that the camera will not show in time; another path is searched.
    PathOutOfView,
    /// The path crosses floor that was never observed; the robot observes this floor first.
    UnseenFloor {
        /// The floor, map frame \[m\].
        at: Vector2,
    },
    /// An obstacle blocks the path that the robot followed.
    PathBlocked {
        /// The robot's position at the obstacle, map frame \[m\].
        at: Vector2,
    },
    /// The planner finds no path.
    NoPath {
        /// The planner's result.
        cause: NoPath,
        /// Floor that was excluded from the search because the robot could not observe it, map frame \[m\].
        unseen: Option<Vector2>,
    },
    /// The pose is unknown everywhere on the map.
    PoseUnknown,
    /// The position is too uncertain.
    PoseUncertain {
        /// Standard deviation of the position \[m\].
        sigma: f64,
    },
    /// The robot is at its goal by its estimate, which is too uncertain for the goal.
    ArrivalUncertain {
        /// Bound of the estimate's error.
        bound: PoseBound,
        /// Largest bound that the goal allows.
        allowed: PoseBound,
    },
    /// The robot is at its goal by its estimate, but scans contradict the odometry during the drive, and nothing has confirmed the pose since.
    ArrivalContradicted,
    /// The position is too uncertain, and the wheels do not respond to commands.
    WheelsUnresponsive {
        /// Standard deviation of the position \[m\].
        sigma: f64,
    },
    /// The bumper was pressed too often on the path to one goal.
    RepeatedContact {
        /// Contacts since the goal was given.
        contacts: u32,
    },
    /// The camera repeatedly loses its view on the path to a viewpoint.
    NoSightOnPath,
    /// The robot makes no progress.
    NoProgress {
        /// Time without progress \[s\].
        time: f64,
        /// The state, in one word.
        state: &'static str,
        /// The reason of that state; `None` if the state has none.
        cause: Option<Box<Reason>>,
    },
    /// The final approach by turns and straight moves fails.
    FinalApproach(ApproachFailure),
    /// The robot is not on its charging station.
    Docking(DockFailure),
    /// The mission is over, and these tasks failed.
    TasksFailed(Vec<TaskFailure>),
    /// The user ended the run.
    Interrupted,
    /// A reason that was read from a file.
    Restored {
        /// The text.
        text: String,
        /// The kinds, outermost first.
        kinds: Vec<ReasonKind>,
    },
}

/// A failed task.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskFailure {
    /// Index of the task in the mission, from 0.
    pub index: usize,
    /// The task.
    pub task: Task,
    /// Reason for the incomplete task.
    pub reason: Reason,
}

impl Reason {
    /// The kinds of this reason and of its causes, outermost first.
    pub fn kinds(&self) -> Vec<ReasonKind> {
        if let Self::Restored { kinds, .. } = self {
            return kinds.clone();
        }
        std::iter::once(self.kind()).chain(self.causes().iter().flat_map(|cause| cause.kinds())).collect()
    }

    /// Whether this reason, or one of its causes, is of a kind.
    pub fn is_due_to(&self, kind: ReasonKind) -> bool {
        self.kinds().contains(&kind)
    }

    /// The direct causes of this reason.
    fn causes(&self) -> Vec<&Self> {
        match self {
            Self::NoProgress { cause: Some(cause), .. } => vec![cause],
            Self::TasksFailed(failures) => failures.iter().map(|failure| &failure.reason).collect(),
            _ => Vec::new(),
        }
    }

    /// The kind of this reason alone.
    pub fn kind(&self) -> ReasonKind {
        match self {
            Self::Safety(stop) => ReasonKind::of_stop(stop),
            Self::StoppingToReplan => ReasonKind::StoppingToReplan,
            Self::MovingObstacle => ReasonKind::MovingObstacle,
            Self::PathOutOfView => ReasonKind::PathOutOfView,
            Self::UnseenFloor { .. } => ReasonKind::UnseenFloor,
            Self::PathBlocked { .. } => ReasonKind::PathBlocked,
            Self::NoPath { cause, .. } => ReasonKind::of_no_path(cause),
            Self::PoseUnknown => ReasonKind::PoseUnknown,
            Self::PoseUncertain { .. } => ReasonKind::PoseUncertain,
            Self::ArrivalUncertain { .. } | Self::ArrivalContradicted => ReasonKind::ArrivalUncertain,
            Self::WheelsUnresponsive { .. } => ReasonKind::WheelsUnresponsive,
            Self::RepeatedContact { .. } => ReasonKind::RepeatedContact,
            Self::NoSightOnPath => ReasonKind::NoSightOnPath,
            Self::NoProgress { .. } => ReasonKind::NoProgress,
            Self::FinalApproach(_) => ReasonKind::FinalApproach,
            Self::Docking(failure) => ReasonKind::of_docking(*failure),
            Self::TasksFailed(_) => ReasonKind::TasksFailed,
            Self::Interrupted => ReasonKind::Interrupted,
            Self::Restored { kinds, .. } => kinds.first().copied().unwrap_or(ReasonKind::Unknown),
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Safety(stop) => stop.fmt(f),
            Self::StoppingToReplan => f.write_str("stopping to plan again"),
            Self::MovingObstacle => f.write_str("a moving obstacle blocks the path"),
            Self::PathOutOfView => f.write_str("the path leaves the camera's view; searching another path"),
            Self::UnseenFloor { at } => {
                write!(f, "the path crosses unseen floor at ({:.2}, {:.2}) m; observing it first", at.x, at.y)
            }
            Self::PathBlocked { at } => {
                write!(f, "an obstacle at ({:.2}, {:.2}) m blocks the path", at.x, at.y)
            }
            Self::NoPath { cause, unseen: None } => cause.fmt(f),
            Self::NoPath { cause, unseen: Some(at) } => {
                write!(f, "{cause}; the floor at ({:.2}, {:.2}) m could not be observed", at.x, at.y)
            }
            Self::PoseUnknown => {
                f.write_str("the pose is unknown: the robot was moved, or the map shows another place")
            }
            Self::PoseUncertain { sigma } => write!(f, "position uncertain: standard deviation {sigma:.2} m"),
            Self::ArrivalUncertain { bound, allowed } => uncertain_arrival(f, *bound, *allowed),
            Self::ArrivalContradicted => f.write_str(
                "arrived, but not sure: two scans contradicted the odometry, and no image has confirmed the pose since",
            ),
            Self::WheelsUnresponsive { sigma } => write!(
                f,
                "position uncertain, standard deviation {sigma:.2} m: {}",
                SlowReason::WheelsCountNothing
            ),
            Self::RepeatedContact { contacts } => {
                write!(f, "{contacts} bumper contacts on the path")
            }
            Self::NoSightOnPath => {
                f.write_str("the camera view is lost repeatedly on the path to the viewpoint")
            }
            Self::NoProgress { time, cause: Some(cause), .. } => {
                write!(f, "no progress for {time:.0} s: {cause}")
            }
            Self::NoProgress { time, state, cause: None } => {
                write!(f, "no progress for {time:.0} s: {state}")
            }
            Self::FinalApproach(failure) => failure.fmt(f),
            Self::Docking(failure) => failure.fmt(f),
            Self::TasksFailed(failures) => {
                let texts: Vec<String> = failures.iter().map(ToString::to_string).collect();
                f.write_str(&texts.join("; "))
            }
            Self::Interrupted => f.write_str("the user ended the run"),
            Self::Restored { text, .. } => f.write_str(text),
        }
    }
}

/// An arrival by an uncertain pose: the bound of the position, or that of the heading if the position is certain.
fn uncertain_arrival(f: &mut fmt::Formatter<'_>, bound: PoseBound, allowed: PoseBound) -> fmt::Result {
    f.write_str("arrived, but not sure: ")?;
    if bound.distance > allowed.distance {
        let (known, needed) = (bound.distance, allowed.distance);
        return write!(f, "the position is known within {known:.2} m (95 %), the goal needs {needed:.2} m");
    }
    let (known, needed) = (bound.heading.to_degrees(), allowed.heading.to_degrees());
    write!(f, "the heading is known within {known:.1} deg (95 %), the goal needs {needed:.1} deg")
}

impl Serialize for Reason {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        RecordedReason { reason: self.to_string(), kinds: self.kinds() }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Reason {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let RecordedReason { reason, kinds } = RecordedReason::deserialize(deserializer)?;
        Ok(Self::Restored { text: reason, kinds })
    }
}

impl fmt::Display for TaskFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "task {} ({}): {}", self.index + 1, self.task, self.reason)
    }
}

#[cfg(test)]
mod tests;

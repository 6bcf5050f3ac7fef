//! The table of transitions: which state follows which, and for what reason.

use crate::reason::TransitionReason;
use TransitionReason as R;

/// A state without its data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum StateKind {
    /// No goal.
    Idle,
    /// The robot is at rest until the opening is over and the first scan is in the grid.
    Initialize,
    /// One turn on the spot that observes the surroundings.
    Spin,
    /// About to plan, at rest.
    Plan,
    /// Following a trajectory.
    Drive,
    /// Point stabilisation onto the exact goal.
    Approach,
    /// A turn on the spot to the heading of a viewpoint.
    Face,
    /// At the goal by an uncertain pose: turning on the spot to observe the surroundings.
    Confirm,
    /// Turns and straight moves onto the exact goal.
    Maneuver,
    /// A turn or a straight drive relative to the robot's pose.
    Relative,
    /// A motion at a charging station.
    Station,
    /// At rest until the way is free: stopped by the safety monitor, or without a path.
    Wait,
    /// No path is known: turns on the spot, or a drive to a viewpoint.
    Recover,
    /// The pose is unknown: turning on the spot to recognise a place.
    Relocalize,
    /// The robot is at rest at the goal.
    Arrived,
    /// The goal is abandoned.
    Stopped,
}

/// States from which a transition leads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Source {
    /// Every state.
    Any,
    /// Every state with a goal to reach.
    Active,
    /// These states.
    Of(&'static [StateKind]),
}

/// A row of the table: from each of the sources, for this reason, to each of the targets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Transition {
    pub(crate) from: Source,
    pub(crate) reason: TransitionReason,
    pub(crate) to: &'static [StateKind],
}

use StateKind::*;

/// States without a goal to reach. Each other state is active.
const OVER: &[StateKind] = &[Idle, Arrived, Stopped];
/// States of a search for a path: they share the data of the search.
const SEARCH: &[StateKind] = &[Plan, Wait, Recover];
/// States in which a plan to the goal may be made.
const PLANS: Source = Source::Of(&[Plan, Drive, Wait, Recover]);

/// All transitions.
pub(crate) const TRANSITIONS: &[Transition] = &[
    Transition {
        from: Source::Any,
        reason: R::GoalGiven,
        to: &[Initialize, Spin, Maneuver, Relative, Station],
    },
    Transition { from: Source::Any, reason: R::GoalDropped, to: &[Idle] },
    Transition { from: Source::Of(&[Drive]), reason: R::GoalGiven, to: &[Drive] },
    Transition { from: Source::Of(&[Initialize]), reason: R::Initialized, to: &[Plan] },
    Transition { from: PLANS, reason: R::PlanFound, to: &[Drive] },
    Transition { from: PLANS, reason: R::StoppingToReplan, to: &[Wait] },
    Transition { from: PLANS, reason: R::MovingObstacle, to: &[Wait] },
    Transition { from: Source::Of(&[Drive]), reason: R::PathOutOfView, to: &[Wait] },
    Transition { from: Source::Of(SEARCH), reason: R::UnseenFloor, to: &[Recover] },
    Transition { from: PLANS, reason: R::DetourRefused, to: &[Wait] },
    Transition { from: PLANS, reason: R::NoPath, to: &[Recover, Stopped] },
    Transition { from: Source::Of(&[Wait, Recover]), reason: R::NoPath, to: &[Wait] },
    Transition {
        from: Source::Of(&[Drive, Approach, Face, Wait, Recover]),
        reason: R::SafetyStop,
        to: &[Wait],
    },
    Transition { from: Source::Of(&[Wait]), reason: R::SafetyPass, to: &[Drive] },
    Transition { from: Source::Of(&[Drive]), reason: R::TrajectoryEnd, to: &[Approach, Face] },
    Transition {
        from: Source::Of(&[Plan, Drive, Approach, Wait, Recover]),
        reason: R::ManeuverChosen,
        to: &[Maneuver],
    },
    Transition {
        from: Source::Of(&[Spin, Drive, Approach, Face, Maneuver, Relative, Station]),
        reason: R::GoalReached,
        to: &[Arrived],
    },
    Transition {
        from: Source::Of(&[Drive, Approach, Face, Maneuver]),
        reason: R::ArrivalUncertain,
        to: &[Confirm, Stopped],
    },
    Transition { from: Source::Of(&[Confirm]), reason: R::ArrivalUncertain, to: &[Stopped] },
    Transition { from: Source::Of(&[Confirm]), reason: R::PoseConfirmed, to: &[Plan] },
    Transition { from: Source::Of(&[Maneuver, Relative, Station]), reason: R::MotionFailed, to: &[Stopped] },
    Transition { from: Source::Active, reason: R::RepeatedContact, to: &[Stopped] },
    Transition { from: Source::Of(&[Wait]), reason: R::NoSightOnPath, to: &[Stopped] },
    Transition { from: Source::Active, reason: R::NoProgress, to: &[Stopped] },
    Transition { from: Source::Active, reason: R::PoseLost, to: &[Relocalize] },
    Transition { from: Source::Of(&[Relocalize]), reason: R::PoseFound, to: &[Initialize, Spin] },
];

impl StateKind {
    /// Whether the state has no goal to reach.
    pub(crate) fn is_over(self) -> bool {
        OVER.contains(&self)
    }
}

impl Source {
    fn holds(self, kind: StateKind) -> bool {
        match self {
            Self::Any => true,
            Self::Active => !kind.is_over(),
            Self::Of(kinds) => kinds.contains(&kind),
        }
    }
}

/// Whether the table holds the transition.
pub(crate) fn is_allowed(from: StateKind, reason: TransitionReason, to: StateKind) -> bool {
    TRANSITIONS.iter().any(|row| row.reason == reason && row.from.holds(from) && row.to.contains(&to))
}

#[cfg(test)]
mod tests;

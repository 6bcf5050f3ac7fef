//! The table of transitions: which state follows which, and for what reason.

use crate::reason::TransitionReason;
use TransitionReason as R;

/// A state without its data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum StateKind {
    Idle,
    Initializing,
    Planning,
    Driving,
    FinalApproach,
    Maneuvering,
    Waiting,
    Recovering,
    Lost,
    Arrived,
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

/// States in which a plan to the goal may be made.
const PLANS: Source = Source::Of(&[Planning, Driving, Waiting, Recovering]);

/// All transitions.
pub(crate) const TRANSITIONS: &[Transition] = &[
    Transition { from: Source::Any, reason: R::GoalGiven, to: &[Idle, Initializing, Maneuvering] },
    Transition { from: Source::Of(&[Driving]), reason: R::GoalGiven, to: &[Driving] },
    Transition { from: Source::Of(&[Initializing]), reason: R::Initialized, to: &[Planning] },
    Transition { from: PLANS, reason: R::PlanFound, to: &[Driving] },
    Transition { from: PLANS, reason: R::StoppingToReplan, to: &[Waiting] },
    Transition { from: PLANS, reason: R::MovingObstacle, to: &[Waiting] },
    Transition { from: Source::Of(&[Driving]), reason: R::PathOutOfView, to: &[Waiting] },
    Transition {
        from: Source::Of(&[Planning, Waiting, Recovering]),
        reason: R::UnseenFloor,
        to: &[Recovering],
    },
    Transition { from: PLANS, reason: R::NoPath, to: &[Recovering, Stopped] },
    Transition { from: Source::Of(&[Waiting, Recovering]), reason: R::NoPath, to: &[Waiting] },
    Transition {
        from: Source::Of(&[Driving, FinalApproach, Waiting, Recovering]),
        reason: R::SafetyStop,
        to: &[Waiting],
    },
    Transition { from: Source::Of(&[Waiting]), reason: R::SafetyPass, to: &[Driving] },
    Transition { from: Source::Of(&[Driving]), reason: R::TrajectoryEnd, to: &[FinalApproach] },
    Transition {
        from: Source::Of(&[Planning, Driving, FinalApproach, Waiting, Recovering]),
        reason: R::ManeuverChosen,
        to: &[Maneuvering],
    },
    Transition {
        from: Source::Of(&[Initializing, Driving, FinalApproach, Maneuvering]),
        reason: R::GoalReached,
        to: &[Arrived],
    },
    Transition { from: Source::Of(&[Maneuvering]), reason: R::MotionFailed, to: &[Stopped] },
    Transition { from: Source::Active, reason: R::RepeatedContact, to: &[Stopped] },
    Transition { from: Source::Of(&[Waiting]), reason: R::NoSightOnPath, to: &[Stopped] },
    Transition { from: Source::Active, reason: R::NoProgress, to: &[Stopped] },
    Transition { from: Source::Active, reason: R::PoseLost, to: &[Lost] },
    Transition { from: Source::Of(&[Lost]), reason: R::PoseFound, to: &[Initializing] },
];

impl StateKind {
    /// Whether the state has no goal to reach.
    pub(crate) fn is_over(self) -> bool {
        matches!(self, Idle | Arrived | Stopped)
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
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    const KINDS: [StateKind; 11] = [
        Idle,
        Initializing,
        Planning,
        Driving,
        FinalApproach,
        Maneuvering,
        Waiting,
        Recovering,
        Lost,
        Arrived,
        Stopped,
    ];
    /// A row for each state, a column for each next state, both in the order of `KINDS`; `#`: some reason leads there.
    const NEXT: [&str; 11] = [
        "##...#.....", // idle
        "###..#..###", // initializing
        "##.#.####.#", // planning
        "##.########", // driving
        "##...##.###", // final approach
        "##...#..###", // maneuvering
        "##.#.####.#", // waiting
        "##.#.####.#", // recovering
        "##...#..#.#", // lost
        "##...#.....", // arrived
        "##...#.....", // stopped
    ];

    fn reasons() -> BTreeSet<TransitionReason> {
        TRANSITIONS.iter().map(|row| row.reason).collect()
    }

    #[test]
    fn every_pair_of_states_is_allowed_or_refused_as_drawn() {
        for (from, row) in KINDS.into_iter().zip(NEXT) {
            let drawn: String = KINDS
                .into_iter()
                .map(|to| if reasons().iter().any(|why| is_allowed(from, *why, to)) { '#' } else { '.' })
                .collect();
            assert_eq!(drawn, row, "{from:?}");
        }
    }
}

use crate::manoeuvre::Manoeuvre;
use crate::optimal::Certificate;
use crate::scene::Blocker;
use thiserror::Error;
use trundle_core::Invalid;

/// Why there is nothing to plan.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Refusal {
    /// The robot overlaps an obstacle where it stands.
    #[error("the start overlaps {0}")]
    StartBlocked(Blocker),
    /// The robot would overlap an obstacle at the goal.
    #[error("the goal overlaps {0}")]
    GoalBlocked(Blocker),
    /// Docking is for the last metres.
    #[error("the goal is {distance:.2} m away, expected at most {most:.2} m: plan a path there first")]
    TooFar {
        /// From start to goal, m.
        distance: f64,
        /// `docking.max_distance`, m.
        most: f64,
    },
    /// A number of the input.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}

/// What came of planning.
#[derive(Debug, Clone, PartialEq)]
pub enum Plan {
    /// A manoeuvre.
    Found(Solution),
    /// There is none.
    Impossible(Impossible),
}

/// A manoeuvre and what is known about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// What to do.
    pub manoeuvre: Manoeuvre,
    /// No manoeuvre that keeps the margin is faster than this, s.
    pub bound: f64,
    /// The margin that was kept, m.
    pub margin: f64,
}

/// Why there is no manoeuvre.
#[derive(Debug, Clone, PartialEq)]
pub struct Impossible {
    /// What stands in the way.
    pub by: Option<Blocker>,
    /// What was shown; always [`Certificate::None`] by the paper's method.
    pub certificate: Certificate,
    /// What ended the search where it found and showed nothing; with a certificate, where it looked farther off than
    /// `within`. `None` when it was complete.
    pub limit: Option<Limit>,
    /// How far from the line between start and goal motions were thought of, m.
    pub within: f64,
}

/// What ends a search that has neither found a manoeuvre nor shown that there is none: a setting of
/// [`crate::DockingConfig`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// `search_nodes`: so many nodes were expanded.
    SearchNodes,
    /// `most_work`: the search for many motions cost as much.
    MostWork,
    /// `plan_work`: the whole plan did.
    PlanWork,
    /// `points_work`: the whole plan among many points did.
    PointsWork,
}

impl Limit {
    /// The setting's name.
    pub fn setting(self) -> &'static str {
        match self {
            Self::SearchNodes => "search_nodes",
            Self::MostWork => "most_work",
            Self::PlanWork => "plan_work",
            Self::PointsWork => "points_work",
        }
    }
}

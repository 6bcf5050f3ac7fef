//! Results of docking plans.

use crate::certificate::{Certificate, SearchLimit};
use crate::motion::manoeuvre::Manoeuvre;
use crate::scene::blocker::Blocker;
use thiserror::Error;
use trundle_core::Invalid;

/// Reason for a query that cannot be planned.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DockingRefusal {
    /// The robot overlaps an obstacle at the start.
    #[error("the start overlaps {0}")]
    StartBlocked(Blocker),
    /// The robot overlaps an obstacle at the goal.
    #[error("the goal overlaps {0}")]
    GoalBlocked(Blocker),
    /// The goal is too far for docking.
    #[error("the goal is {distance:.2} m away, expected at most {max:.2} m: plan a path there first")]
    TooFar {
        /// Distance from start to goal, m.
        distance: f64,
        /// `docking.max_distance`, m.
        max: f64,
    },
    /// A number of the input is invalid.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}

/// Result of planning.
#[derive(Debug, Clone, PartialEq)]
pub enum DockingPlan {
    /// A manoeuvre.
    Found(Solution),
    /// No manoeuvre exists.
    Impossible(Impossible),
}

/// A manoeuvre, its lower bound and its margin.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The manoeuvre.
    pub manoeuvre: Manoeuvre,
    /// Lower bound of the time of any manoeuvre with this margin, s.
    pub bound: f64,
    /// Margin of the manoeuvre, m.
    pub margin: f64,
}

/// Reason for the absence of a manoeuvre.
#[derive(Debug, Clone, PartialEq)]
pub struct Impossible {
    /// The blocking obstacle.
    pub by: Option<Blocker>,
    /// The proof; always [`Certificate::None`] by the method of \[Hong24\].
    pub certificate: Certificate,
    /// The limit that ended a search without result; with a certificate, the limit of the search beyond `within`. `None` if the
    /// search was complete.
    pub limit: Option<SearchLimit>,
    /// Distance from the line between start and goal within which motions were searched, m.
    pub within: f64,
}

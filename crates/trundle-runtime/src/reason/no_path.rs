//! Reasons for a missing path.

use std::fmt;
use trundle_core::{Invalid, Vector2};
use trundle_planning::Plan;

/// Reason for a missing path.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum NoPath {
    /// The free space does not connect start and goal.
    Blocked {
        /// The reachable point nearest to the goal, map frame \[m\].
        nearest: Vector2,
    },
    /// The footprint at the start overlaps an obstacle.
    StartInObstacle {
        /// The missing distance \[m\].
        missing: f64,
    },
    /// The footprint at the goal overlaps an obstacle.
    GoalInObstacle {
        /// The missing distance \[m\].
        missing: f64,
    },
    /// The goal is in a no-go zone.
    GoalInZone {
        /// Name of the zone: `zone 'stairs'`.
        zone: String,
    },
    /// The start is off the map.
    StartOutside,
    /// The goal is off the map.
    GoalOutside,
    /// The query is invalid.
    Refused(Invalid),
}

impl NoPath {
    /// Reason for the missing path of a plan. `None` if the plan has a path.
    #[must_use]
    pub fn of(plan: &Plan) -> Option<Self> {
        match plan {
            Plan::Found(_) => None,
            Plan::Blocked { nearest } => Some(Self::Blocked { nearest: *nearest }),
            Plan::StartInObstacle { clearance } => Some(Self::StartInObstacle { missing: -clearance }),
            Plan::GoalInObstacle { clearance } => Some(Self::GoalInObstacle { missing: -clearance }),
            Plan::StartOutside => Some(Self::StartOutside),
            Plan::GoalOutside => Some(Self::GoalOutside),
            Plan::Refused(invalid) => Some(Self::Refused(invalid.clone())),
        }
    }
}

impl fmt::Display for NoPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Blocked { nearest } => write!(
                f,
                "no free path to the goal; the nearest reachable point is ({:.2}, {:.2}) m",
                nearest.x, nearest.y
            ),
            Self::StartInObstacle { missing } => {
                write!(f, "the footprint overlaps an obstacle by {missing:.3} m at the start")
            }
            Self::GoalInObstacle { missing } => {
                write!(f, "the footprint overlaps an obstacle by {missing:.3} m at the goal")
            }
            Self::GoalInZone { zone } => write!(f, "the goal is in the no-go {zone}"),
            Self::StartOutside => f.write_str("the robot is off the map"),
            Self::GoalOutside => f.write_str("the goal is off the map"),
            Self::Refused(invalid) => invalid.fmt(f),
        }
    }
}

//! Results of planning.

use crate::curve::analytic_curve::Curve;
use crate::curve::phase::Phase;
use std::fmt;
use trundle_core::{Invalid, Path, Pose2, Trajectory, Vector2};

/// Largest clearance of the footprint that is measured, m. A larger one makes no difference to a plan. Source: ours.
pub const MAX_CLEARANCE_M: f64 = 1.0;

/// Result of a planning request.
#[derive(Debug, Clone, PartialEq)]
pub enum Plan {
    /// A path, a verified curve and its timing.
    Found(Box<PlanResult>),
    /// The free space does not connect start and goal.
    Blocked {
        /// The reachable point nearest to the goal, map frame, m.
        nearest: Vector2,
    },
    /// The footprint at the start overlaps an obstacle.
    StartInObstacle {
        /// Clearance of the footprint, m, negative: the missing distance.
        clearance: f64,
    },
    /// The footprint at the goal overlaps an obstacle.
    GoalInObstacle {
        /// Clearance of the footprint, m, negative: the missing distance.
        clearance: f64,
    },
    /// The start is outside the map, and the robot may not leave the map.
    StartOutside,
    /// The goal is outside the map, and the robot may not leave the map.
    GoalOutside,
    /// An invalid request: a number is not finite, or the map or a distance is too large.
    Refused(Invalid),
}

impl Plan {
    /// Whether no path leads to the goal, or to a point within the goal tolerance.
    pub(crate) fn is_short_of_goal(&self) -> bool {
        match self {
            Self::Blocked { .. } => true,
            Self::Found(result) => matches!(result.instead_of, Some(Self::Blocked { .. })),
            _ => false,
        }
    }

    /// Whether the plan ends nearer to the goal than another plan.
    pub(crate) fn ends_nearer(&self, other: &Self, goal: Pose2) -> bool {
        let off = |plan: &Self| match plan {
            Self::Found(result) => result.trajectory.end().distance(&goal),
            _ => f64::INFINITY,
        };
        off(self) < off(other)
    }
}

/// One sentence for a person.
impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Found(result) => {
                let (length, time) = (result.length, result.trajectory.duration());
                let clearance = clearance_text(result.min_clearance);
                write!(f, "a path of {length:.2} m in {time:.1} s, {clearance} beside obstacles")
            }
            Self::Blocked { nearest } => {
                write!(
                    f,
                    "no path to the goal; the nearest reachable point is ({:.2}, {:.2}) m",
                    nearest.x, nearest.y
                )
            }
            Self::StartInObstacle { clearance } => {
                write!(f, "the robot does not fit at the start: {:.3} m of clearance are missing", -clearance)
            }
            Self::GoalInObstacle { clearance } => {
                write!(f, "the robot does not fit at the goal: {:.3} m of clearance are missing", -clearance)
            }
            Self::StartOutside => write!(f, "the start is off the map"),
            Self::GoalOutside => write!(f, "the goal is off the map"),
            Self::Refused(invalid) => write!(f, "{invalid}"),
        }
    }
}

/// A clearance (m) as text for a person, limited to [`MAX_CLEARANCE_M`].
pub fn clearance_text(metres: f64) -> String {
    if metres < MAX_CLEARANCE_M { format!("{metres:.3} m") } else { format!("{MAX_CLEARANCE_M} m or more") }
}

/// A plan from start to goal.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanResult {
    /// The waypoints, start and goal included. Straight segments between them are free; for a moving robot that must stop first, the first
    /// segment replaces its braking arc.
    pub waypoints: Path,
    /// The path of the search, a cell's side apart.
    pub raw: Path,
    /// Turns and curves, in order.
    pub phases: Vec<Phase>,
    /// The phases with time; at rest at the end.
    pub trajectory: Trajectory,
    /// Length of all curves, m.
    pub length: f64,
    /// Smallest clearance of the footprint along the trajectory, m; at most [`MAX_CLEARANCE_M`]. A negative value is the depth of the
    /// overlap that the robot leaves.
    pub min_clearance: f64,
    /// Whether the descent on the potential of \[Ge00\] was trapped and the geodesic search took over.
    pub fell_back: bool,
    /// Whether the trajectory continues the twist given: false when it starts from rest although the robot moves.
    pub is_continuous: bool,
    /// The reason why the trajectory ends at the reachable point nearest to the goal ([`PlannerConfig::goal_tolerance`]); `None` if it ends
    /// at the goal.
    ///
    /// [`PlannerConfig::goal_tolerance`]: crate::PlannerConfig::goal_tolerance
    pub instead_of: Option<Plan>,
    /// Wait at the start or at a stop on the path, for moving obstacles to pass, s; part of the trajectory.
    pub wait: f64,
}

impl PlanResult {
    /// The curves driven, in order.
    pub fn curves(&self) -> impl Iterator<Item = &Curve> {
        self.phases.iter().filter_map(|phase| match phase {
            Phase::Drive(curve) => Some(curve),
            Phase::Turn { .. } => None,
        })
    }
}

/// Decision about a running plan.
#[derive(Debug, Clone, PartialEq)]
pub enum Replan {
    /// The rest of the plan still holds.
    Keep,
    /// A new plan, from the reference at that time.
    New(Plan),
}

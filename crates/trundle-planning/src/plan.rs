use crate::curve::Curve;
use crate::route::Phase;
use std::fmt;
use trundle_core::{Invalid, Path, Pose2, Trajectory, Vector2};

/// Room beside the robot is measured up to here, m: what is further away makes no difference.
pub const ROOM_CAP: f64 = 1.0;

/// What became of a question for a way.
#[derive(Debug, Clone, PartialEq)]
pub enum Plan {
    /// A way, a verified curve and its timing.
    Found(Box<PlanResult>),
    /// The free space does not connect start and goal.
    Blocked {
        /// The reachable point nearest to the goal, map frame, m.
        nearest: Vector2,
    },
    /// The robot does not fit where it stands.
    StartInObstacle {
        /// Room beside the footprint, m, negative: so much is missing.
        clearance: f64,
    },
    /// The robot does not fit at the goal.
    GoalInObstacle {
        /// Room beside the footprint, m, negative: so much is missing.
        clearance: f64,
    },
    /// The start is off the map, which may not be left.
    StartOutside,
    /// The goal is off the map, which may not be left.
    GoalOutside,
    /// The question was no question: a number is not finite, or a map or distance is out of proportion.
    Refused(Invalid),
}

impl Plan {
    /// Whether there is no way to the goal, or to a place near enough to it, as far as is known.
    pub(crate) fn falls_short(&self) -> bool {
        match self {
            Self::Blocked { .. } => true,
            Self::Found(result) => matches!(result.instead_of, Some(Self::Blocked { .. })),
            _ => false,
        }
    }

    /// Whether it is a way that ends nearer to the goal than another plan does.
    pub(crate) fn ends_nearer(&self, other: &Self, goal: Pose2) -> bool {
        let off = |plan: &Self| match plan {
            Self::Found(result) => result.trajectory.end().distance(&goal),
            _ => f64::INFINITY,
        };
        off(self) < off(other)
    }
}

/// One sentence.
impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Found(result) => {
                let (length, time) = (result.length, result.trajectory.duration());
                let room = room_in_words(result.min_clearance);
                write!(f, "a way of {length:.2} m in {time:.1} s, {room} beside obstacles")
            }
            Self::Blocked { nearest } => {
                write!(
                    f,
                    "no way to the goal; the nearest reachable point is ({:.2}, {:.2}) m",
                    nearest.x, nearest.y
                )
            }
            Self::StartInObstacle { clearance } => {
                write!(f, "the robot does not fit at the start: {:.3} m are missing", -clearance)
            }
            Self::GoalInObstacle { clearance } => {
                write!(f, "the robot does not fit at the goal: {:.3} m are missing", -clearance)
            }
            Self::StartOutside => write!(f, "the start is off the map"),
            Self::GoalOutside => write!(f, "the goal is off the map"),
            Self::Refused(invalid) => write!(f, "{invalid}"),
        }
    }
}

/// Room beside the robot (m) for a person: it is measured up to a limit only.
pub fn room_in_words(metres: f64) -> String {
    if metres < ROOM_CAP { format!("{metres:.3} m") } else { format!("{ROOM_CAP} m or more") }
}

/// A way from start to goal.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanResult {
    /// The few way-points, start and goal included: straight pieces between them are free, except that the first one
    /// stands for the braking arc where a moving robot has to stop first.
    pub way_points: Path,
    /// What the potential (or the wave) walked, a cell's side apart.
    pub raw: Path,
    /// Turns and curves, in order.
    pub phases: Vec<Phase>,
    /// The phases with time; at rest at the end.
    pub trajectory: Trajectory,
    /// Length of all curves, m.
    pub length: f64,
    /// Least room beside the footprint along the trajectory, m; at most [`ROOM_CAP`]. Negative: how deep it is inside what it
    /// leaves.
    pub min_clearance: f64,
    /// Whether the printed potential was trapped and the geodesic one took over.
    pub fell_back: bool,
    /// Whether the trajectory continues the twist given: false when it starts from rest although the robot moves.
    pub is_continuous: bool,
    /// Why the trajectory ends at the reachable place nearest to the goal instead ([`PlannerConfig::goal_tolerance`]); `None`
    /// where it ends at the goal.
    ///
    /// [`PlannerConfig::goal_tolerance`]: crate::PlannerConfig::goal_tolerance
    pub instead_of: Option<Plan>,
    /// How long the robot stands, at the start or at a stop on the way, to let something pass, s; part of the trajectory.
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

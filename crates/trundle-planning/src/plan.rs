use crate::curve::Curve;
use crate::route::Phase;
use trundle_core::{Invalid, Path, Trajectory, Vector2};

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
    /// The start is off the map, or further than the map may be left.
    StartOutside,
    /// The goal is off the map, or further than the map may be left.
    GoalOutside,
    /// The question was no question: a number is not finite, or a map or distance is out of proportion.
    Refused(Invalid),
}

/// A way from start to goal.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanResult {
    /// The few way-points, start and goal included: straight pieces between them are free.
    pub way_points: Path,
    /// What the potential (or the wave) walked, a cell's side apart.
    pub raw: Path,
    /// Turns and curves, in order.
    pub phases: Vec<Phase>,
    /// The phases with time; at rest at the end.
    pub trajectory: Trajectory,
    /// Length of all curves, m.
    pub length: f64,
    /// Least room beside the footprint along the trajectory, m; capped at 2 m.
    pub min_clearance: f64,
    /// Whether the printed potential was trapped and the geodesic one took over.
    pub fell_back: bool,
    /// Whether the trajectory continues the twist given: false when it starts from rest although the robot moves.
    pub is_continuous: bool,
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

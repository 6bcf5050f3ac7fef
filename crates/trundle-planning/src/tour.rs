use crate::{Plan, PlanResult};
use trundle_core::{Trajectory, TrajectoryPoint};

/// Plans through several goals in a row: at rest at each.
#[derive(Debug, Clone, PartialEq)]
pub struct Tour {
    /// From each goal to the next, the first from the start.
    pub legs: Vec<PlanResult>,
    /// All of them, one after the other.
    pub trajectory: Trajectory,
}

impl Tour {
    /// The legs, one after the other; at least one.
    pub(crate) fn new(legs: Vec<PlanResult>) -> Self {
        let mut points: Vec<TrajectoryPoint> = Vec::new();
        for leg in &legs {
            let begin = points.pop().map_or(0.0, |last| last.time);
            points.extend(
                leg.trajectory.points().iter().map(|p| TrajectoryPoint { time: begin + p.time, ..*p }),
            );
        }
        let trajectory = Trajectory::new(points).expect("invariant: legs begin where the last one ended");
        Self { legs, trajectory }
    }
}

/// What becomes of a plan under way.
#[derive(Debug, Clone, PartialEq)]
pub enum Replan {
    /// The rest of it still holds.
    Keep,
    /// Another, from the reference at that time.
    New(Plan),
}

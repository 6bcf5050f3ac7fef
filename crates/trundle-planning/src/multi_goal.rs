//! Plans through several goals.

use crate::plan::PlanResult;
use trundle_core::{Trajectory, TrajectoryPoint};

/// Plans through several goals in order, at rest at each.
#[derive(Debug, Clone, PartialEq)]
pub struct MultiGoalPlan {
    /// A plan from each goal to the next, the first from the start.
    pub legs: Vec<PlanResult>,
    /// The joined trajectory.
    pub trajectory: Trajectory,
}

impl MultiGoalPlan {
    /// Joins the legs; at least one.
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

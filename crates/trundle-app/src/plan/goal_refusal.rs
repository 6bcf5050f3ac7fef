//! Goals without a plan, and goals for which another pose was taken.

use trundle_core::Pose2;
use trundle_planning::Plan;

/// The leg of a request that has no plan.
#[derive(Debug)]
pub struct GoalRefusal {
    /// The goal's number, from 0.
    pub goal: usize,
    /// Start of the leg: the start, or the pose at which the robot stops at the previous goal.
    pub from: Pose2,
    /// The planner's answer.
    pub why: Plan,
}

/// A goal for which another pose was taken.
#[derive(Debug)]
pub struct MovedGoal {
    /// The goal's number, from 0.
    pub goal: usize,
    /// Pose at which the robot stops instead.
    pub to: Pose2,
    /// Distance of that pose from the goal, m.
    pub off: f64,
    /// The reason why the goal itself has no plan.
    pub why: String,
}

impl MovedGoal {
    /// The refusal in one sentence.
    #[must_use]
    pub fn note(&self) -> String {
        let Self { goal, to, off, why } = self;
        format!(
            "goal {} moved to ({:.2}, {:.2}) m, {off:.2} m from the one asked for: {why}",
            goal + 1,
            to.x,
            to.y
        )
    }
}

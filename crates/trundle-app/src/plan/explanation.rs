//! Sentences on why a goal has no plan or was moved.

use super::goal_refusal::{GoalRefusal, MovedGoal};
use super::request::{NamedPose, PlanRequest};
use crate::MapExtent;
use trundle_core::{OccupancyGrid, Pose2, Twist2};
use trundle_planning::{MultiGoalPlan, Plan, Planner, WaypointGraph};

/// Distance below which two positions count as the same \[m\]. Beyond it a message gives the position. Source: ours.
const MAX_SAME_POSITION_M: f64 = 0.01;

impl PlanRequest {
    /// The goals for which another pose was taken, with distance and reason.
    pub fn goals_moved(&mut self, plan: &MultiGoalPlan) -> Vec<MovedGoal> {
        let mut found = Vec::new();
        for (goal, leg) in plan.legs.iter().enumerate() {
            let Some(instead_of) = &leg.instead_of else { continue };
            let why = match instead_of {
                Plan::Blocked { .. } => "no path leads there".to_owned(),
                refusal => refusal.to_string(),
            };
            let from = leg.trajectory.points()[0].pose;
            let why = format!("{why}{}", self.what_changes(instead_of, from, goal));
            let to = leg.trajectory.end();
            found.push(MovedGoal { goal, to, off: to.distance(&self.goals[goal].pose), why });
        }
        found
    }

    /// One sentence: the leg without a plan, and the reason.
    pub fn explain(&mut self, refusal: &GoalRefusal) -> String {
        let GoalRefusal { goal, why, .. } = refusal;
        let from = self.leg_start(refusal);
        let mut whole = format!("from {} to {}", from.describe(), self.goals[*goal].describe());
        if self.goals.len() > 1 {
            whole = format!("goal {}, {whole}", goal + 1);
        }
        if matches!(why, Plan::Blocked { .. }) && self.graph.is_some() {
            whole = format!("{whole} along the graph");
        }
        let place = match why {
            Plan::StartOutside | Plan::GoalOutside => {
                format!(", which has {}", MapExtent::of(self.grid.geometry()))
            }
            _ => String::new(),
        };
        format!("{whole}: {why}{place}{}", self.what_changes(why, refusal.from, *goal))
    }

    /// The pose at which a leg begins: the start or the previous goal, with its name if the robot stands at that pose.
    fn leg_start(&self, refusal: &GoalRefusal) -> NamedPose {
        let asked = if refusal.goal == 0 { &self.start } else { &self.goals[refusal.goal - 1] };
        let is_there = asked.pose.distance(&refusal.from) < MAX_SAME_POSITION_M;
        let round = |value: f64| (value * 100.0).round() / 100.0;
        let Pose2 { x, y, theta } = refusal.from;
        if is_there {
            asked.clone()
        } else {
            NamedPose { pose: Pose2::new(round(x), round(y), theta), name: None }
        }
    }

    /// Part of the keep-out mask or of unknown space in a refusal; empty if the answer is the same without them.
    fn what_changes(&mut self, why: &Plan, from: Pose2, goal: usize) -> &'static str {
        match self.without_the_mask(why, from, goal) {
            "" => self.with_unknown_free(why, from, goal),
            mask => mask,
        }
    }

    /// Part of unknown space in a refusal; empty if the answer is the same if unknown cells are free.
    fn with_unknown_free(&mut self, why: &Plan, from: Pose2, goal: usize) -> &'static str {
        let Some(planner) = &mut self.unknown_free else { return "" };
        let open = plan_leg(planner, (&self.grid, self.graph.as_ref()), from, self.goals[goal].pose);
        match (why, open) {
            (Plan::StartInObstacle { .. }, Plan::StartInObstacle { .. })
            | (Plan::GoalInObstacle { .. }, Plan::GoalInObstacle { .. } | Plan::StartInObstacle { .. }) => "",
            (Plan::StartInObstacle { .. }, _) => {
                "; the start lies in or beside unknown space, which planning.unknown = \"obstacle\" forbids"
            }
            (Plan::GoalInObstacle { .. }, _) => {
                "; the goal lies in or beside unknown space, which planning.unknown = \"obstacle\" forbids"
            }
            (Plan::Blocked { .. }, Plan::Found(_)) => {
                "; a path leads through unknown space, which planning.unknown = \"obstacle\" forbids"
            }
            _ => "",
        }
    }

    /// Part of the keep-out mask in a refusal; empty if the answer is the same without it.
    fn without_the_mask(&mut self, why: &Plan, from: Pose2, goal: usize) -> &'static str {
        if self.keep_out.is_none() {
            return "";
        }
        let place = (&self.grid, self.graph.as_ref());
        let bare = plan_leg(&mut self.unmasked, place, from, self.goals[goal].pose);
        let same = |of: fn(&Plan) -> bool| of(why) && of(&bare);
        match why {
            Plan::StartInObstacle { .. } if !same(|plan| matches!(plan, Plan::StartInObstacle { .. })) => {
                "; it would without the keep-out mask"
            }
            Plan::GoalInObstacle { .. } if !same(|plan| matches!(plan, Plan::GoalInObstacle { .. })) => {
                "; it would without the keep-out mask"
            }
            Plan::Blocked { .. } if matches!(bare, Plan::Found(_)) => {
                "; without the keep-out mask there is one"
            }
            _ => "",
        }
    }
}

/// The plan of one leg from rest, along the graph if one is given.
fn plan_leg(
    planner: &mut Planner,
    (grid, graph): (&OccupancyGrid, Option<&WaypointGraph>),
    from: Pose2,
    goal: Pose2,
) -> Plan {
    match graph {
        Some(graph) => planner.plan_on_graph(grid, graph, from, Twist2::ZERO, goal),
        None => planner.plan(grid, from, Twist2::ZERO, goal),
    }
}

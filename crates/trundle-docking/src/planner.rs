use crate::cloud::{MANY_POINTS, plan_in_cloud};
use crate::config::{BESIDE, DockingConfig, Method, WIDER};
use crate::geometry::Hull;
use crate::manoeuvre::Manoeuvre;
use crate::optimal::{self, Certificate, Effort, Outcome, Task};
use crate::paper;
use crate::scene::{Blocker, Scene};
use crate::space::Space;
use thiserror::Error;
use trundle_core::{Footprint, Invalid, Pose2};

/// Pieces of a scene above which the bound is sought with fewer boxes.
const MANY_PIECES: usize = 200;

/// Why there is nothing to plan.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Refusal {
    /// The robot overlaps an obstacle where it stands.
    #[error("the start overlaps obstacle {} at ({:.3}, {:.3}) m", .0.obstacle, .0.at.x, .0.at.y)]
    StartBlocked(Blocker),
    /// The robot would overlap an obstacle at the goal.
    #[error("the goal overlaps obstacle {} at ({:.3}, {:.3}) m", .0.obstacle, .0.at.x, .0.at.y)]
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
    /// How far from the line between start and goal motions were thought of, m.
    pub within: f64,
}

/// Plans manoeuvres onto a goal pose.
#[derive(Debug, Clone)]
pub struct Docker {
    config: DockingConfig,
}

impl Docker {
    /// A planner.
    ///
    /// # Errors
    /// When a setting is outside its range.
    pub fn new(config: DockingConfig) -> Result<Self, Invalid> {
        Ok(Self { config: config.validated()? })
    }

    /// Its settings.
    pub fn config(&self) -> &DockingConfig {
        &self.config
    }

    /// Plans from `start` to `goal`, both `map_from_base`.
    ///
    /// # Errors
    /// When start or goal are in collision or too far apart, or a number is not finite.
    pub fn plan(
        &self,
        footprint: &Footprint,
        scene: &Scene,
        start: Pose2,
        goal: Pose2,
    ) -> Result<Plan, Refusal> {
        self.plan_keeping(self.config.margin, footprint, scene, start, goal)
    }

    /// As [`Docker::plan`], with another margin (m) than the configuration's: of a pose that is known so well (see
    /// [`crate::margin_of`]).
    ///
    /// # Errors
    /// As [`Docker::plan`].
    pub fn plan_keeping(
        &self,
        margin: f64,
        footprint: &Footprint,
        scene: &Scene,
        start: Pose2,
        goal: Pose2,
    ) -> Result<Plan, Refusal> {
        let most = self.checked(margin, footprint, scene, &start, &goal)?;
        let task = self.task(start, goal);
        let near = around(footprint, scene, &task);
        let least = most.min(0.0);
        let mut plan = self.plan_with(footprint, &near, &task, most);
        for margin in [most / 3.0, least] {
            if matches!(plan, Plan::Impossible(_)) && most > least {
                plan = self.plan_with(footprint, &near, &task, margin);
            }
        }
        if matches!(plan, Plan::Impossible(_)) && self.config.method == Method::Optimal {
            let wider = Task { reach: WIDER * task.reach, ..task };
            plan = self.plan_with(footprint, &around(footprint, scene, &wider), &wider, least);
        }
        Ok(plan)
    }

    fn task(&self, start: Pose2, goal: Pose2) -> Task {
        Task { start, goal, limits: self.config.limits, reach: self.config.reach }
    }

    /// Among all points, or among a few of them first where there are many.
    fn plan_with(&self, footprint: &Footprint, scene: &Scene, task: &Task, margin: f64) -> Plan {
        if scene.points().len() <= MANY_POINTS || self.config.method == Method::Paper {
            return self.plan_among(footprint, scene, task, margin);
        }
        plan_in_cloud(footprint, scene, margin, |few| self.plan_among(footprint, few, task, margin))
    }

    fn plan_among(&self, footprint: &Footprint, scene: &Scene, task: &Task, margin: f64) -> Plan {
        let (config, limits) = (&self.config, self.config.limits);
        let mut space = Space::new(footprint, margin, scene);
        let effort = Effort {
            nodes: config.search_nodes,
            // A box costs as many looks as there are pieces; what is left of them in thick clouds must not cost more.
            boxes: config.bound_boxes.min(config.bound_boxes * MANY_PIECES / scene.len().max(1)),
            gap: config.gap,
            cell: config.position_tolerance,
        };
        let nothing = |by, certificate| Plan::Impossible(Impossible { by, certificate, within: task.reach });
        if config.method == Method::Paper {
            let found = paper::plan(&space, task.start, task.goal, &limits, &config.paper);
            return found.map_or(nothing(None, Certificate::None), |manoeuvre| {
                Plan::Found(Solution { manoeuvre, bound: 0.0, margin })
            });
        }
        match optimal::find(*task, &mut space, effort) {
            Outcome::Found((_, legs), bound) => {
                let (_, motions) = legs.motions(task, &mut space).expect("invariant: found legs are free");
                Plan::Found(Solution {
                    manoeuvre: Manoeuvre::new(task.start, &motions, limits),
                    bound,
                    margin,
                })
            }
            Outcome::Apart(certificate, by) => nothing(by, certificate),
            Outcome::Nothing => nothing(None, Certificate::None),
        }
    }

    /// A time (s) that no manoeuvre from `start` to `goal` beats, sought with the effort of the configuration; at most
    /// `known`, the time of a manoeuvre.
    ///
    /// # Errors
    /// As [`Docker::plan`].
    pub fn bound(
        &self,
        footprint: &Footprint,
        scene: &Scene,
        start: Pose2,
        goal: Pose2,
        known: f64,
    ) -> Result<f64, Refusal> {
        let margin = self.checked(self.config.margin, footprint, scene, &start, &goal)?;
        let task = self.task(start, goal);
        let near = around(footprint, scene, &task);
        let mut space = Space::new(footprint, margin, &near);
        Ok(optimal::bound(&task, &mut space, known, self.config.gap, self.config.bound_boxes))
    }

    /// The margin that start and goal leave, m.
    pub(crate) fn checked(
        &self,
        margin: f64,
        footprint: &Footprint,
        scene: &Scene,
        start: &Pose2,
        goal: &Pose2,
    ) -> Result<f64, Refusal> {
        for (name, pose) in [("start", start), ("goal", goal)] {
            if !pose.is_finite() {
                let value = format!("({}, {}, {})", pose.x, pose.y, pose.theta);
                return Err(Invalid::new(name, value, "", "finite numbers").into());
            }
        }
        let (distance, most) = (start.distance(goal), self.config.max_distance);
        if distance > most {
            return Err(Refusal::TooFar { distance, most });
        }
        let (mut margin, overlap) = (margin, self.config.overlap);
        let least = Hull::new(footprint, -overlap);
        let ends = [(start, Refusal::StartBlocked as fn(Blocker) -> Refusal), (goal, Refusal::GoalBlocked)];
        for (pose, refusal) in ends {
            if let Some((clearance, by)) = scene.clearance_of(&least, pose, margin + overlap + 2e-4) {
                if clearance <= 1e-9 {
                    return Err(refusal(by));
                }
                margin = margin.min(clearance - overlap);
            }
        }
        Ok(margin)
    }
}

/// The part of a scene that a manoeuvre may meet.
fn around(footprint: &Footprint, scene: &Scene, task: &Task) -> Scene {
    let half = task.half() + footprint.circumscribed_radius() + BESIDE;
    scene.around(task.center(), half)
}

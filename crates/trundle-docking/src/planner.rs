use crate::cloud::FEW;
use crate::config::{BESIDE, DockingConfig, Method, WIDER};
use crate::margins::Margins;
use crate::optimal::{self, Certificate, Effort, Task};
use crate::pace::{Meter, Planning, at_once};
use crate::paper::{self, Decision, PaperMethod};
use crate::plan::{Impossible, Limit, Plan, Refusal, Solution};
use crate::scene::{Blocker, Scene};
use crate::space::Space;
use std::sync::Arc;
use trundle_collision::RoundedHull;
use trundle_core::{Footprint, Invalid, Pose2};

/// Pieces of a scene above which the bound is sought with fewer boxes.
const MANY_PIECES: usize = 200;

/// Plans manoeuvres onto a goal pose.
#[derive(Debug, Clone)]
pub struct Docker {
    config: DockingConfig,
}

/// What is searched for.
#[derive(Clone, Copy)]
struct Question<'a> {
    /// A margin that start and goal leave, m.
    most: f64,
    footprint: &'a Footprint,
    scene: &'a Scene,
    task: Task,
    meter: &'a Arc<Meter>,
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
        let meter = &Meter::endless(self.most_of(scene));
        let task = self.task(start, goal);
        Ok(at_once(self.search(Question { most, footprint, scene, task, meter })))
    }

    /// Begins what [`Docker::plan_keeping`] does at once: the search then goes on in parts ([`Planning::go_on`]).
    ///
    /// # Errors
    /// As [`Docker::plan`].
    pub fn begin(
        &self,
        margin: f64,
        footprint: &Footprint,
        scene: &Scene,
        start: Pose2,
        goal: Pose2,
    ) -> Result<Planning, Refusal> {
        let most = self.checked(margin, footprint, scene, &start, &goal)?;
        let (docker, footprint, task) = (self.clone(), footprint.clone(), self.task(start, goal));
        let scene = around(&footprint, scene, &wider(task));
        let meter = Meter::rationed(self.most_of(&scene));
        let counted = Arc::clone(&meter);
        let search = async move {
            let (footprint, scene, meter) = (&footprint, &scene, &counted);
            docker.search(Question { most, footprint, scene, task, meter }).await
        };
        Ok(Planning::new(meter, search))
    }

    /// Begins one decision of the paper's method from `pose`, with so many recovery moves behind it; it goes on in parts.
    ///
    /// # Errors
    /// As [`Docker::plan`].
    pub(crate) fn begin_decision(
        &self,
        margin: f64,
        footprint: &Footprint,
        scene: &Scene,
        (pose, goal): (Pose2, Pose2),
        recoveries: usize,
    ) -> Result<Planning<Decision>, Refusal> {
        let margin = self.checked(margin, footprint, scene, &pose, &goal)?;
        let scene = around(footprint, scene, &self.task(pose, goal));
        let (hull, limits, config) =
            (RoundedHull::new(footprint, margin), self.config.limits, self.config.paper.clone());
        let meter = Meter::rationed(self.most_of(&scene));
        let counted = Arc::clone(&meter);
        Ok(Planning::new(meter, async move {
            let space = Space::metered(hull, &scene, counted);
            let method = PaperMethod { space: &space, limits, config: &config };
            method.decide(&pose, &goal, recoveries).await
        }))
    }

    /// The search.
    async fn search(&self, question: Question<'_>) -> Plan {
        match self.config.method {
            Method::Paper => self.by_paper(question).await,
            Method::Optimal => self.by_search(question).await,
        }
    }

    /// By the optimal method: first near the ends, then farther about.
    async fn by_search(&self, Question { most, footprint, scene, task, meter }: Question<'_>) -> Plan {
        let near = around(footprint, scene, &task);
        let least = most.min(0.0);
        let (effort, saving) = (self.effort(&near), self.config.margin_saving);
        let close = Margins { footprint, scene: &near, task, most, least, effort, saving, meter };
        let nearby = match close.plan().await {
            Plan::Impossible(nearby) => nearby,
            found => return found,
        };
        let task = wider(task);
        let far = around(footprint, scene, &task);
        let effort = self.effort(&far);
        let wide = Margins { footprint, scene: &far, task, most: least, least, effort, saving, meter };
        match wide.plan().await {
            Plan::Impossible(none) if none.certificate == Certificate::None => {
                let limit = if meter.is_spent() { Some(self.limit_of(scene).1) } else { none.limit };
                // What was shown near the ends stands.
                let shown = if nearby.certificate == Certificate::None { none } else { nearby };
                Plan::Impossible(Impossible { limit, ..shown })
            }
            plan => plan,
        }
    }

    /// What a plan may cost as a whole.
    fn most_of(&self, scene: &Scene) -> u64 {
        self.limit_of(scene).0
    }

    /// The same, and which setting says so.
    fn limit_of(&self, scene: &Scene) -> (u64, Limit) {
        let (plan, points) = (self.config.plan_work, self.config.points_work);
        if scene.points().len() > FEW && points < plan {
            (points, Limit::PointsWork)
        } else {
            (plan, Limit::PlanWork)
        }
    }

    fn effort(&self, scene: &Scene) -> Effort {
        let config = &self.config;
        Effort {
            nodes: config.search_nodes,
            // A box costs as many looks as there are pieces.
            boxes: config.bound_boxes.min(config.bound_boxes * MANY_PIECES / scene.pieces().len().max(1)),
            gap: config.gap,
            cell: config.position_tolerance,
            work: config.most_work,
        }
    }

    /// By the paper's method, with the whole margin, a third of it, or none.
    async fn by_paper(&self, Question { most, footprint, scene, task, meter }: Question<'_>) -> Plan {
        let (config, near) = (&self.config, around(footprint, scene, &task));
        let margins = if most > 0.0 { vec![most, most / 3.0, 0.0] } else { vec![most] };
        for margin in margins {
            let space = Space::metered(RoundedHull::new(footprint, margin), &near, Arc::clone(meter));
            let found = paper::plan(&space, task.start, task.goal, &config.limits, &config.paper).await;
            if let Some(manoeuvre) = found {
                return Plan::Found(Solution { manoeuvre, bound: 0.0, margin });
            }
        }
        let limit = meter.is_spent().then(|| self.limit_of(scene).1);
        let (certificate, within) = (Certificate::None, task.reach);
        Plan::Impossible(Impossible { by: None, certificate, limit, within })
    }

    fn task(&self, start: Pose2, goal: Pose2) -> Task {
        Task { start, goal, limits: self.config.limits, reach: self.config.reach }
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
        let (gap, boxes) = (self.config.gap, self.config.bound_boxes);
        Ok(at_once(optimal::bound(&task, &mut space, known, gap, boxes)))
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
        let least = RoundedHull::new(footprint, -overlap);
        let ends = [(start, Refusal::StartBlocked as fn(Blocker) -> Refusal), (goal, Refusal::GoalBlocked)];
        for (pose, refusal) in ends {
            if let Some((clearance, by)) = scene.clearance_of(&least, pose, margin + overlap + 2e-4) {
                if clearance <= 1e-9 {
                    return Err(refusal(scene.named(by)));
                }
                margin = margin.min(clearance - overlap);
            }
        }
        Ok(margin)
    }
}

/// The same task, farther about.
fn wider(task: Task) -> Task {
    Task { reach: WIDER * task.reach, ..task }
}

/// The part of a scene that a manoeuvre may meet.
fn around(footprint: &Footprint, scene: &Scene, task: &Task) -> Scene {
    let half = task.half() + footprint.circumscribed_radius() + BESIDE;
    scene.around(task.center(), half)
}

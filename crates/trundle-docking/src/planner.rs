//! The docking planner.

use crate::certificate::{Certificate, SearchLimit};
use crate::contact_space::ContactSpace;
use crate::docking_config::{DockingConfig, Method, OBSTACLE_MARGIN_M, WIDER_REACH_FACTOR};
use crate::docking_plan::{DockingPlan, DockingRefusal, Impossible, Solution};
use crate::hong24;
use crate::hong24::decide::{Decision, Hong24Method};
use crate::legs::query::DockingQuery;
use crate::margin_selection::MarginSelection;
use crate::point_queries::limits::FEW_POINTS;
use crate::scene::blocker::Blocker;
use crate::scene::obstacle_scene::ObstacleScene;
use crate::search::min_time;
use crate::search::min_time::Effort;
use crate::work_budget::{PlanningJob, WorkBudget, run_to_end};
use std::sync::Arc;
use trundle_collision::{CONTACT_TOLERANCE_M, RoundedHull};
use trundle_core::{Footprint, Invalid, Pose2};

/// Number of segments of a scene above which fewer boxes are used for the lower bound. Source: ours.
const MANY_SEGMENTS: usize = 200;

/// Plans manoeuvres onto a goal pose.
#[derive(Debug, Clone)]
pub struct DockingPlanner {
    config: DockingConfig,
}

/// A search for a whole plan, in parts.
pub type DockingJob = PlanningJob<DockingPlan>;

/// One search.
#[derive(Clone, Copy)]
struct SearchRequest<'a> {
    /// A margin that start and goal allow, m.
    max: f64,
    footprint: &'a Footprint,
    scene: &'a ObstacleScene,
    query: DockingQuery,
    budget: &'a Arc<WorkBudget>,
}

impl DockingPlanner {
    /// A planner.
    ///
    /// # Errors
    /// When a setting is outside its range.
    pub fn new(config: DockingConfig) -> Result<Self, Invalid> {
        Ok(Self { config: config.validated()? })
    }

    /// Settings of the planner.
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
        scene: &ObstacleScene,
        start: Pose2,
        goal: Pose2,
    ) -> Result<DockingPlan, DockingRefusal> {
        self.plan_with_margin(self.config.margin, footprint, scene, start, goal)
    }

    /// Like [`DockingPlanner::plan`] with another margin (m) than the configuration's, for a pose of known uncertainty (see
    /// [`crate::margin_of`]).
    ///
    /// # Errors
    /// As [`DockingPlanner::plan`].
    pub fn plan_with_margin(
        &self,
        margin: f64,
        footprint: &Footprint,
        scene: &ObstacleScene,
        start: Pose2,
        goal: Pose2,
    ) -> Result<DockingPlan, DockingRefusal> {
        let max = self.checked(margin, footprint, scene, &start, &goal)?;
        let budget = &WorkBudget::endless(self.max_of(scene));
        let query = self.query(start, goal);
        Ok(run_to_end(self.search(SearchRequest { max, footprint, scene, query, budget })))
    }

    /// Starts the search of [`DockingPlanner::plan_with_margin`]; it continues in parts ([`PlanningJob::advance`]).
    ///
    /// # Errors
    /// As [`DockingPlanner::plan`].
    pub fn begin(
        &self,
        margin: f64,
        footprint: &Footprint,
        scene: &ObstacleScene,
        start: Pose2,
        goal: Pose2,
    ) -> Result<DockingJob, DockingRefusal> {
        let max = self.checked(margin, footprint, scene, &start, &goal)?;
        let (planner, footprint, query) = (self.clone(), footprint.clone(), self.query(start, goal));
        let scene = around(&footprint, scene, &wider(query));
        let budget = WorkBudget::rationed(self.max_of(&scene));
        let counted = Arc::clone(&budget);
        let search = async move {
            let (footprint, scene, budget) = (&footprint, &scene, &counted);
            planner.search(SearchRequest { max, footprint, scene, query, budget }).await
        };
        Ok(PlanningJob::new(budget, search))
    }

    /// Starts one decision of \[Hong24\] from `pose`, after `recoveries` recovery moves; it continues in parts.
    ///
    /// # Errors
    /// As [`DockingPlanner::plan`].
    pub(crate) fn start_decision(
        &self,
        margin: f64,
        footprint: &Footprint,
        scene: &ObstacleScene,
        (pose, goal): (Pose2, Pose2),
        recoveries: usize,
    ) -> Result<PlanningJob<Decision>, DockingRefusal> {
        let margin = self.checked(margin, footprint, scene, &pose, &goal)?;
        let scene = around(footprint, scene, &self.query(pose, goal));
        let (hull, limits, config) =
            (RoundedHull::new(footprint, margin), self.config.limits, self.config.paper.clone());
        let budget = WorkBudget::rationed(self.max_of(&scene));
        let counted = Arc::clone(&budget);
        Ok(PlanningJob::new(budget, async move {
            let space = ContactSpace::metered(hull, &scene, counted);
            let method = Hong24Method { space: &space, limits, config: &config };
            method.decide(&pose, &goal, recoveries).await
        }))
    }

    /// The search.
    async fn search(&self, request: SearchRequest<'_>) -> DockingPlan {
        match self.config.method {
            Method::Hong24 => self.by_paper(request).await,
            Method::Optimal => self.by_search(request).await,
        }
    }

    /// The optimal method: first near the ends, then in a wider region.
    async fn by_search(
        &self,
        SearchRequest { max, footprint, scene, query, budget }: SearchRequest<'_>,
    ) -> DockingPlan {
        let near = around(footprint, scene, &query);
        let min = max.min(0.0);
        let (effort, saving) = (self.effort(&near), self.config.margin_saving);
        let close = MarginSelection { footprint, scene: &near, query, max, min, effort, saving, budget };
        let nearby = match close.plan().await {
            DockingPlan::Impossible(nearby) => nearby,
            found => return found,
        };
        let query = wider(query);
        let far = around(footprint, scene, &query);
        let effort = self.effort(&far);
        let wide = MarginSelection { footprint, scene: &far, query, max: min, min, effort, saving, budget };
        match wide.plan().await {
            DockingPlan::Impossible(none) if none.certificate == Certificate::None => {
                let limit = if budget.is_spent() { Some(self.limit_of(scene).1) } else { none.limit };
                // A proof found near the ends is valid for the whole query.
                let shown = if nearby.certificate == Certificate::None { none } else { nearby };
                DockingPlan::Impossible(Impossible { limit, ..shown })
            }
            plan => plan,
        }
    }

    /// Cost limit of a whole plan.
    fn max_of(&self, scene: &ObstacleScene) -> u64 {
        self.limit_of(scene).0
    }

    /// Cost limit of a whole plan, and the setting it comes from.
    fn limit_of(&self, scene: &ObstacleScene) -> (u64, SearchLimit) {
        let (plan, points) = (self.config.plan_work, self.config.points_work);
        if scene.points().len() > FEW_POINTS && points < plan {
            (points, SearchLimit::PointsWork)
        } else {
            (plan, SearchLimit::PlanWork)
        }
    }

    fn effort(&self, scene: &ObstacleScene) -> Effort {
        let config = &self.config;
        Effort {
            nodes: config.search_nodes,
            // A box tests every segment.
            boxes: config.bound_boxes.min(config.bound_boxes * MANY_SEGMENTS / scene.pieces().len().max(1)),
            gap: config.gap,
            cell: config.position_tolerance,
            work: config.max_work,
        }
    }

    /// The method of \[Hong24\], with the full margin, a third of it, or none.
    async fn by_paper(
        &self,
        SearchRequest { max, footprint, scene, query, budget }: SearchRequest<'_>,
    ) -> DockingPlan {
        let (config, near) = (&self.config, around(footprint, scene, &query));
        let margins = if max > 0.0 { vec![max, max / 3.0, 0.0] } else { vec![max] };
        for margin in margins {
            let space = ContactSpace::metered(RoundedHull::new(footprint, margin), &near, Arc::clone(budget));
            let found =
                hong24::plan::plan(&space, query.start, query.goal, &config.limits, &config.paper).await;
            if let Some(manoeuvre) = found {
                return DockingPlan::Found(Solution { manoeuvre, bound: 0.0, margin });
            }
        }
        let limit = budget.is_spent().then(|| self.limit_of(scene).1);
        let (certificate, within) = (Certificate::None, query.reach);
        DockingPlan::Impossible(Impossible { by: None, certificate, limit, within })
    }

    fn query(&self, start: Pose2, goal: Pose2) -> DockingQuery {
        DockingQuery { start, goal, limits: self.config.limits, reach: self.config.reach }
    }

    /// A lower bound (s) of the time of any manoeuvre from `start` to `goal`, with the effort of the configuration; at most `known`, the
    /// time of a known manoeuvre.
    ///
    /// # Errors
    /// As [`DockingPlanner::plan`].
    pub fn bound(
        &self,
        footprint: &Footprint,
        scene: &ObstacleScene,
        start: Pose2,
        goal: Pose2,
        known: f64,
    ) -> Result<f64, DockingRefusal> {
        let margin = self.checked(self.config.margin, footprint, scene, &start, &goal)?;
        let query = self.query(start, goal);
        let near = around(footprint, scene, &query);
        let mut space = ContactSpace::new(footprint, margin, &near);
        let (gap, boxes) = (self.config.gap, self.config.bound_boxes);
        Ok(run_to_end(min_time::bound(&query, &mut space, known, gap, boxes)))
    }

    /// The margin that start and goal allow, m.
    pub(crate) fn checked(
        &self,
        margin: f64,
        footprint: &Footprint,
        scene: &ObstacleScene,
        start: &Pose2,
        goal: &Pose2,
    ) -> Result<f64, DockingRefusal> {
        for (name, pose) in [("start", start), ("goal", goal)] {
            if !pose.is_finite() {
                let value = format!("({}, {}, {})", pose.x, pose.y, pose.theta);
                return Err(Invalid::new(name, value, "", "finite numbers").into());
            }
        }
        let (distance, max) = (start.distance(goal), self.config.max_distance);
        if distance > max {
            return Err(DockingRefusal::TooFar { distance, max });
        }
        let (mut margin, overlap) = (margin, self.config.overlap);
        let min = RoundedHull::new(footprint, -overlap);
        let ends = [
            (start, DockingRefusal::StartBlocked as fn(Blocker) -> DockingRefusal),
            (goal, DockingRefusal::GoalBlocked),
        ];
        for (pose, refusal) in ends {
            if let Some((clearance, by)) = scene.clearance_of(&min, pose, margin + overlap + 2e-4) {
                if clearance <= 1e-9 {
                    return Err(refusal(scene.named(by)));
                }
                margin = margin.min(clearance - overlap - CONTACT_TOLERANCE_M);
            }
        }
        Ok(margin)
    }
}

/// The same query in a wider region.
fn wider(query: DockingQuery) -> DockingQuery {
    DockingQuery { reach: WIDER_REACH_FACTOR * query.reach, ..query }
}

/// The part of a scene that a manoeuvre can touch.
fn around(footprint: &Footprint, scene: &ObstacleScene, query: &DockingQuery) -> ObstacleScene {
    let half = query.half() + footprint.circumscribed_radius() + OBSTACLE_MARGIN_M;
    scene.around(query.center(), half)
}

//! Planning requests: the area, the distance fields, and the passes over them.

use crate::area::area;
use crate::config::PlannerConfig;
use crate::masks::cost_mask::CostMask;
use crate::masks::keep_out::kept_out;
use crate::masks::speed_mask::SpeedMask;
use crate::plan::{MAX_CLEARANCE_M, Plan};
use crate::polygon::robot_shape::RobotShape;
use crate::query::answer::{may_be_tight, plan};
use crate::query::grid_refinement::refined;
use crate::query::plan_query::{PlanQuery, SearchBuffers};
use crate::query::stage_timer::{PlanningTimes, StageTimer};
use crate::search::potential::PotentialKind;
use crate::search::waypoint_graph::WaypointGraph;
use crate::timing::speeds::DriveModel;
use trundle_core::{GridGeometry, Invalid, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_grid::{DistanceField, UnknownIs};

/// A planning request.
#[derive(Clone, Copy)]
struct Request<'a> {
    graph: Option<&'a WaypointGraph>,
    start: Pose2,
    twist: Twist2,
    goal: Pose2,
}

/// The data of a planner, and its passes over one request.
#[derive(Debug)]
pub(super) struct PlannerCore {
    pub(super) config: PlannerConfig,
    /// The configuration for plans along lanes.
    pub(super) on_lanes: PlannerConfig,
    pub(super) shape: RobotShape,
    pub(super) drive: DriveModel,
    pub(super) memory: SearchBuffers,
    /// Distance field of the last plan.
    pub(super) field: Option<DistanceField>,
    /// Distance field of the last plan on cells of half the side.
    pub(super) fine: Option<DistanceField>,
    pub(super) keep_out: Option<OccupancyGrid>,
    pub(super) speeds: Option<SpeedMask>,
    pub(super) cost_mask: Option<CostMask>,
    pub(super) clock: Option<fn() -> f64>,
    pub(super) times: PlanningTimes,
}

impl PlannerCore {
    pub(super) fn plan_on(
        &mut self,
        grid: &OccupancyGrid,
        graph: Option<&WaypointGraph>,
        start: Pose2,
        twist: Twist2,
        goal: Pose2,
    ) -> Plan {
        if let Err(invalid) = finite(start, twist, goal) {
            return Plan::Refused(invalid);
        }
        let merged = match self.merged(grid) {
            Ok(merged) => merged,
            Err(invalid) => return Plan::Refused(invalid),
        };
        let grid = merged.as_ref().unwrap_or(grid);
        self.times = PlanningTimes::default();
        let wrapped = |pose: Pose2| Pose2::new(pose.x, pose.y, pose.theta);
        let q = Request { graph, start: wrapped(start), twist, goal: wrapped(goal) };
        let mut plan = self.plan_within(grid, q, 0.0);
        if matches!(plan, Plan::Blocked { .. }) && self.may_leave() {
            let wider = self.plan_within(grid, q, self.config.beyond);
            if !matches!(wider, Plan::Refused(_)) {
                plan = wider;
            }
        }
        plan
    }

    pub(super) fn may_leave(&self) -> bool {
        self.config.unknown == UnknownIs::Free && self.config.beyond > 0.0
    }

    fn plan_within(&mut self, grid: &OccupancyGrid, q: Request<'_>, beyond: f64) -> Plan {
        let geometry = match self.area_for(grid.geometry(), q, beyond) {
            Ok(geometry) => geometry,
            Err(Plan::GoalOutside) if self.config.goal_tolerance > 0.0 => {
                return self.plan_to_the_edge(grid, q, beyond);
            }
            Err(plan) => return plan,
        };
        let timer = StageTimer::new(self.clock);
        let last = self.field.take();
        let field = timer.time(|times| &mut times.field, || self.updated_field(last, geometry, grid));
        let mut memory = std::mem::take(&mut self.memory);
        let query = self.query(grid, &field, q.graph, &timer);
        let mut plan = plan(&query, &mut memory, q.start, q.twist, q.goal);
        if may_be_tight(&query, &mut memory, &plan, q.start, q.goal) {
            let fine = self.plan_finely(grid, q, &mut memory, &timer, beyond);
            plan = fine.filter(|fine| fine.ends_nearer(&plan, q.goal)).unwrap_or(plan);
        }
        self.memory = memory;
        self.field = Some(field);
        self.times = self.times.plus(timer.times());
        plan
    }

    /// Plan for a goal outside the map: to the reachable point nearest to the goal's nearest cell, if within the tolerance.
    fn plan_to_the_edge(&mut self, grid: &OccupancyGrid, q: Request<'_>, beyond: f64) -> Plan {
        let edge = nearest_centre(grid.geometry(), q.goal.position());
        let goal = Pose2::new(edge.x, edge.y, q.goal.theta);
        match self.plan_within(grid, Request { goal, ..q }, beyond) {
            Plan::Found(mut plan)
                if plan.trajectory.end().distance(&q.goal) <= self.config.goal_tolerance =>
            {
                plan.instead_of = Some(Plan::GoalOutside);
                Plan::Found(plan)
            }
            Plan::StartInObstacle { clearance } => Plan::StartInObstacle { clearance },
            _ => Plan::GoalOutside,
        }
    }

    /// A plan with other points of cells than their centres, or with cells of half the side if their number allows it.
    fn plan_finely(
        &mut self,
        grid: &OccupancyGrid,
        q: Request<'_>,
        memory: &mut SearchBuffers,
        timer: &StageTimer,
        beyond: f64,
    ) -> Option<Plan> {
        let fine = refined(grid);
        let grid = fine.as_ref().unwrap_or(grid);
        let geometry = self.area_for(grid.geometry(), q, beyond).ok()?;
        let last = self.fine.take();
        let field = timer.time(|times| &mut times.field, || self.updated_field(last, geometry, grid));
        let query = PlanQuery { is_fine: true, ..self.query(grid, &field, q.graph, timer) };
        let plan = plan(&query, memory, q.start, q.twist, q.goal);
        self.fine = Some(field);
        Some(plan)
    }

    /// The grid with the keep-out mask; `None` without a mask.
    pub(super) fn merged(&self, grid: &OccupancyGrid) -> Result<Option<OccupancyGrid>, Invalid> {
        self.keep_out.as_ref().map(|mask| kept_out(grid, mask, self.may_leave())).transpose()
    }

    pub(super) fn query<'a>(
        &'a self,
        grid: &'a OccupancyGrid,
        field: &'a DistanceField,
        graph: Option<&'a WaypointGraph>,
        timer: &'a StageTimer,
    ) -> PlanQuery<'a> {
        PlanQuery {
            config: if graph.is_some() { &self.on_lanes } else { &self.config },
            shape: &self.shape,
            drive: &self.drive,
            field,
            grid,
            speeds: self.speeds.as_ref(),
            cost_mask: self.cost_mask.as_ref(),
            graph,
            timer,
            is_fine: false,
        }
    }

    /// The distance field over `geometry`: the last field, updated, if it covers the same cells.
    fn updated_field(
        &self,
        last: Option<DistanceField>,
        geometry: GridGeometry,
        grid: &OccupancyGrid,
    ) -> DistanceField {
        match last {
            Some(mut field) if *field.geometry() == geometry => {
                field.update(grid);
                field
            }
            _ => DistanceField::over(geometry, grid, self.config.unknown, self.reach(geometry.resolution)),
        }
    }

    /// The largest distance from obstacles that matters to a plan, with cells for interpolation, m.
    fn reach(&self, resolution: f64) -> f64 {
        let PlannerConfig { room, potential, timing, .. } = self.config;
        let wanted = [room.comfort, room.margin, timing.full_speed_clearance, MAX_CLEARANCE_M];
        let reach = if potential.kind == PotentialKind::Printed { potential.reach } else { 0.0 };
        self.shape.radius + wanted.into_iter().fold(reach, f64::max) + 4.0 * resolution
    }

    /// The area to plan in.
    fn area_for(&self, grid: &GridGeometry, q: Request<'_>, beyond: f64) -> Result<GridGeometry, Plan> {
        let (start, goal) = (q.start.position(), q.goal.position());
        if !self.may_leave() {
            if grid.cell_at(start).is_none() {
                return Err(Plan::StartOutside);
            }
            return if grid.cell_at(goal).is_none() { Err(Plan::GoalOutside) } else { Ok(*grid) };
        }
        area(grid, start, goal, beyond).map_err(Plan::Refused)
    }
}

/// The centre of the cell that is nearest to a point off the grid.
fn nearest_centre(grid: &GridGeometry, point: Vector2) -> Vector2 {
    let half = Vector2::repeat(grid.resolution / 2.0);
    let size = Vector2::new(grid.width as f64, grid.height as f64) * grid.resolution;
    point.sup(&(grid.origin + half)).inf(&(grid.origin + size - half))
}

fn finite(start: Pose2, twist: Twist2, goal: Pose2) -> Result<(), Invalid> {
    let numbers = [
        ("start x", start.x, "m"),
        ("start y", start.y, "m"),
        ("start heading", start.theta, "rad"),
        ("start speed", twist.v, "m/s"),
        ("start turn rate", twist.omega, "rad/s"),
        ("goal x", goal.x, "m"),
        ("goal y", goal.y, "m"),
        ("goal heading", goal.theta, "rad"),
    ];
    numbers
        .into_iter()
        .try_for_each(|(name, value, unit)| trundle_core::require_finite(name, value, unit).map(drop))
}

//! Interface of the planner: plans from pose to pose, through zones and around moving obstacles.

use crate::config::PlannerConfig;
use crate::curve::fit::config::CurveConfig;
use crate::masks::cost_mask::CostMask;
use crate::masks::keep_out::{cut, kept_out};
use crate::masks::speed_mask::SpeedMask;
use crate::moving_obstacles::forecast::{
    MAX_PAUSE_S, MovingObstacle, close_cells, delayed, first_encounter_of,
};
use crate::multi_goal::MultiGoalPlan;
use crate::path_validation::{Obstruction, ShapeEscape, max_overlap, reduced_shape, validate_layers};
use crate::plan::{Plan, PlanResult, Replan};
use crate::planner::core::PlannerCore;
use crate::polygon::robot_shape::RobotShape;
use crate::query::plan_query::SearchBuffers;
use crate::query::stage_timer::{PlanningTimes, StageTimer};
use crate::query::yield_stop::with_yield_stop;
use crate::search::escape::cells_around;
use crate::search::waypoint_graph::WaypointGraph;
use crate::timing::speeds::DriveModel;
use trundle_core::{
    DifferentialDrive, DriveLimits, Footprint, Invalid, OccupancyGrid, Pose2, Trajectory, Twist2,
};
use trundle_grid::{DistanceField, UnknownIs};

/// Largest distance of a corridor's side from a lane, m: a robot on a lane is expected on the lane. Source: ours.
const LANE_HALF_WIDTH_M: f64 = 0.2;

/// Plans waypoints, a verified curve and a trajectory from a grid, a pose and a goal.
///
/// The robot is the circumscribed disc of its footprint if this disc fits, else the polygon. Deterministic: equal requests give equal
/// results, bit for bit.
#[derive(Debug)]
pub struct Planner {
    core: PlannerCore,
    /// The robot's own limits.
    full: DriveLimits,
}

impl Planner {
    /// A planner for a robot.
    ///
    /// # Errors
    /// When a number of the configuration, the limits or the drive is outside its range.
    pub fn new(
        config: PlannerConfig,
        footprint: &Footprint,
        limits: DriveLimits,
        drive: DifferentialDrive,
    ) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let drive = DriveModel {
            limits: limits.validated()?,
            half_base: drive.validated()?.wheelbase / 2.0,
            config: config.timing,
        };
        let (shape, memory) = (RobotShape::new(footprint), SearchBuffers::default());
        let reach = config.curve.reach.min(LANE_HALF_WIDTH_M);
        let on_lanes = PlannerConfig { curve: CurveConfig { reach, ..config.curve }, ..config };
        Ok(Self {
            full: limits,
            core: PlannerCore {
                config,
                on_lanes,
                shape,
                drive,
                memory,
                field: None,
                fine: None,
                keep_out: None,
                speeds: None,
                cost_mask: None,
                clock: None,
                times: PlanningTimes::default(),
            },
        })
    }

    /// Limits the forward speed of the next plans, m/s, above 0. The robot's own limit still applies.
    pub fn limit_speed(&mut self, speed: f64) {
        self.core.drive.limits.v = speed.min(self.full.v);
    }

    /// Limits the turn rate of the next plans, rad/s, above 0. The robot's own limit still applies.
    pub fn limit_turn_rate(&mut self, omega: f64) {
        self.core.drive.limits.omega = omega.min(self.full.omega);
    }

    /// Sets the distance from a blocked goal that still counts, m, 0 to 100, for the next plans ([`PlannerConfig::goal_tolerance`]).
    pub fn set_goal_tolerance(&mut self, tolerance: f64) {
        self.core.config.goal_tolerance = tolerance;
        self.core.on_lanes.goal_tolerance = tolerance;
    }

    /// Sets a clock that counts seconds, for [`Planner::stage_times`]. Plans do not depend on it.
    pub fn set_clock(&mut self, clock: Option<fn() -> f64>) {
        self.core.clock = clock;
    }

    /// Times of the stages of the last plan.
    pub fn stage_times(&self) -> PlanningTimes {
        self.core.times
    }

    /// Sets the keep-out mask: its occupied cells are obstacles too. The mask may have its own resolution and extent: every cell of the
    /// grid that overlaps an occupied cell of the mask is forbidden.
    pub fn set_keep_out(&mut self, mask: Option<OccupancyGrid>) {
        self.core.keep_out = mask;
    }

    /// Sets the cost mask: a path through costly cells is taken only if the detour costs more.
    pub fn set_cost_mask(&mut self, mask: Option<CostMask>) {
        self.core.cost_mask = mask;
    }

    /// Sets the speed mask: no trajectory is faster than its limits.
    pub fn set_speed_mask(&mut self, mask: Option<SpeedMask>) {
        self.core.speeds = mask;
    }

    /// Plans from `start`, moving with `start_twist`, to rest at `goal` (map frame).
    ///
    /// A robot that moves forward gets a trajectory that continues its motion. Without such a curve, the robot first brakes on its arc. If
    /// the arc has no clearance either, the plan starts from rest, which [`PlanResult::is_continuous`] reports.
    pub fn plan(&mut self, grid: &OccupancyGrid, start: Pose2, start_twist: Twist2, goal: Pose2) -> Plan {
        self.core.plan_on(grid, None, start, start_twist, goal)
    }

    /// Like [`Planner::plan`], along the free lanes of a waypoint graph.
    pub fn plan_on_graph(
        &mut self,
        grid: &OccupancyGrid,
        graph: &WaypointGraph,
        start: Pose2,
        start_twist: Twist2,
        goal: Pose2,
    ) -> Plan {
        self.core.plan_on(grid, Some(graph), start, start_twist, goal)
    }

    /// Plans through `goals` in order, at rest at each.
    ///
    /// # Errors
    /// The number of the first goal that cannot be reached from the previous one, and the reason; without goals, number 0 and a refusal.
    pub fn plan_multi_goal(
        &mut self,
        grid: &OccupancyGrid,
        start: Pose2,
        start_twist: Twist2,
        goals: &[Pose2],
    ) -> Result<MultiGoalPlan, (usize, Plan)> {
        self.multi_goal(grid, None, (start, start_twist), goals)
    }

    /// [`Planner::plan_multi_goal`], each leg along the lanes of a waypoint graph.
    ///
    /// # Errors
    /// As [`Planner::plan_multi_goal`].
    pub fn plan_multi_goal_on_graph(
        &mut self,
        grid: &OccupancyGrid,
        graph: &WaypointGraph,
        start: Pose2,
        start_twist: Twist2,
        goals: &[Pose2],
    ) -> Result<MultiGoalPlan, (usize, Plan)> {
        self.multi_goal(grid, Some(graph), (start, start_twist), goals)
    }

    /// Like [`Planner::plan`], among moving obstacles. Each is forecast at constant velocity for 2 s; obstacles at rest are treated as
    /// static if that costs less than 10 s. The result passes the obstacles, or waits: at the start, or at a stop on the path for a moving
    /// robot. The variant with the earlier arrival is chosen. If both fail, the result is [`Plan::Blocked`] at the start, and the robot
    /// should stop.
    pub fn plan_among_moving(
        &mut self,
        grid: &OccupancyGrid,
        obstacles: &[MovingObstacle],
        start: Pose2,
        start_twist: Twist2,
        goal: Pose2,
    ) -> Plan {
        let obstacles: &[MovingObstacle] =
            &obstacles.iter().map(|obstacle| obstacle.with_margin()).collect::<Vec<_>>();
        let open = match self.plan(grid, start, start_twist, goal) {
            Plan::Found(plan) if obstacles.iter().any(MovingObstacle::is_at_rest) => {
                plan.trajectory.duration()
            }
            Plan::Found(plan) => return self.past(grid, obstacles, plan, start_twist, goal),
            none => return none,
        };
        if let Some((closed, clear)) =
            self.clear_of_standing(grid, obstacles, (start, start_twist), (goal, open))
            && let Plan::Found(plan) = self.past(&closed, obstacles, clear, start_twist, goal)
        {
            return Plan::Found(plan);
        }
        // Plans again: the distance field is that of the closed grid.
        match self.plan(grid, start, start_twist, goal) {
            Plan::Found(plan) => self.past(grid, obstacles, plan, start_twist, goal),
            none => none,
        }
    }

    /// The plan `direct`, or its best variant among moving obstacles.
    fn past(
        &mut self,
        grid: &OccupancyGrid,
        obstacles: &[MovingObstacle],
        direct: Box<PlanResult>,
        start_twist: Twist2,
        goal: Pose2,
    ) -> Plan {
        let radius = self.core.shape.radius;
        if first_encounter_of(&direct.trajectory, 0.0, obstacles, radius).is_none() {
            return Plan::Found(direct);
        }
        let start = direct.trajectory.points()[0].pose;
        let late = if direct.trajectory.points()[0].twist == Twist2::ZERO {
            delayed(&direct.trajectory, obstacles, radius)
        } else {
            self.with_yield_stop(grid, &direct, obstacles)
        };
        let around = self.plan_around(grid, obstacles, &direct, start_twist, goal);
        let late = late.map(|(trajectory, wait)| Box::new(PlanResult { trajectory, wait, ..*direct }));
        let earlier = |plan: &PlanResult| plan.trajectory.duration();
        match (around, late) {
            (Some(around), Some(late)) if earlier(&around) <= earlier(&late) => Plan::Found(around),
            (_, Some(late)) => Plan::Found(late),
            (Some(around), None) => Plan::Found(around),
            (None, None) => Plan::Blocked { nearest: start.position() },
        }
    }

    /// A plan on the grid closed at the resting obstacles. It is continuous, leads to the goal itself, and is faster than a wait until the
    /// obstacles are static, compared with the `direct` plan (s).
    fn clear_of_standing(
        &mut self,
        grid: &OccupancyGrid,
        obstacles: &[MovingObstacle],
        (start, twist): (Pose2, Twist2),
        (goal, direct): (Pose2, f64),
    ) -> Option<(OccupancyGrid, Box<PlanResult>)> {
        let standing: Vec<MovingObstacle> =
            obstacles.iter().filter(|obstacle| obstacle.is_at_rest()).copied().collect();
        let mut closed = grid.clone();
        close_cells(&mut closed, &standing, 0.0);
        let Plan::Found(plan) = self.plan(&closed, start, twist, goal) else { return None };
        let is_good = plan.is_continuous
            && plan.instead_of.is_none()
            && plan.trajectory.duration() < direct + MAX_PAUSE_S;
        is_good.then_some((closed, plan))
    }

    /// Decides, `time` seconds into the plan `current`, whether the plan is valid after changes of map, goal or moving obstacles. The rest
    /// of the plan remains while it leads to `goal` and is free. Otherwise a new plan starts at its reference pose and twist: continuous in
    /// position, heading, curvature and speed (see [`PlanResult::is_continuous`]).
    pub fn replan(
        &mut self,
        grid: &OccupancyGrid,
        obstacles: &[MovingObstacle],
        current: &PlanResult,
        time: f64,
        goal: Pose2,
    ) -> Replan {
        let end = current.trajectory.end();
        let same = end.distance(&goal) <= self.core.config.goal_tolerance.max(1e-2)
            && trundle_core::difference_of_angles(end.theta, goal.theta).abs() < 1e-2;
        let clear = self.first_encounter(&current.trajectory, time, obstacles).is_none();
        if same && clear && self.validate_trajectory(grid, &current.trajectory, time).is_ok() {
            return Replan::Keep;
        }
        let now = current.trajectory.at(time);
        Replan::New(self.plan_among_moving(grid, obstacles, now.pose, now.twist, goal))
    }

    /// Whether the rest of `trajectory`, from `from` seconds on, is free on a newer grid and the keep-out mask.
    ///
    /// # Errors
    /// The first contact of the footprint. A footprint that overlaps an obstacle at the start may continue near the start while its overlap
    /// does not grow, like a plan from such a start.
    pub fn validate_trajectory(
        &self,
        grid: &OccupancyGrid,
        trajectory: &Trajectory,
        from: f64,
    ) -> Result<(), Obstruction> {
        let mask = self.core.keep_out.as_ref().map(|mask| (mask, UnknownIs::Free));
        let layers: Vec<_> = std::iter::once((grid, self.core.config.unknown)).chain(mask).collect();
        let shape = reduced_shape(&self.core.shape);
        validate_layers(&layers, trajectory, from, &shape, |pose| self.escape(grid, pose, &shape))
    }

    /// The escape of a shape from its overlap at a pose, on the grid and the mask.
    fn escape(&self, grid: &OccupancyGrid, pose: Pose2, shape: &RobotShape) -> Option<ShapeEscape> {
        let around = cells_around(grid.geometry(), pose.position(), max_overlap(shape), shape.radius);
        let mut around = cut(grid, around);
        if let Some(mask) = &self.core.keep_out {
            around = kept_out(&around, mask, false).ok()?;
        }
        ShapeEscape::new(&around, self.core.config.unknown, pose, shape)
    }

    /// Time until the robot, `from` seconds into `trajectory` now, first meets a moving obstacle, s; `None` if it meets none
    /// within 2 s. Costs microseconds.
    pub fn first_encounter(
        &self,
        trajectory: &Trajectory,
        from: f64,
        obstacles: &[MovingObstacle],
    ) -> Option<f64> {
        first_encounter_of(trajectory, from, obstacles, self.core.shape.radius)
    }

    /// The distance field of the last plan, for pictures.
    pub fn field(&self) -> Option<&DistanceField> {
        self.core.field.as_ref()
    }

    fn multi_goal(
        &mut self,
        grid: &OccupancyGrid,
        graph: Option<&WaypointGraph>,
        (mut from, mut twist): (Pose2, Twist2),
        goals: &[Pose2],
    ) -> Result<MultiGoalPlan, (usize, Plan)> {
        let mut legs: Vec<PlanResult> = Vec::new();
        let mut times = PlanningTimes::default();
        for (i, goal) in goals.iter().enumerate() {
            match self.core.plan_on(grid, graph, from, twist, *goal) {
                Plan::Found(leg) => legs.push(*leg),
                other => return Err((i, other)),
            }
            times = times.plus(self.core.times);
            (from, twist) = (legs[i].trajectory.end(), Twist2::ZERO);
        }
        if legs.is_empty() {
            return Err((0, Plan::Refused(Invalid::new("goals of a multi_goal", 0, "", "1 or more"))));
        }
        self.core.times = times;
        Ok(MultiGoalPlan::new(legs))
    }

    /// The direct plan with a stop and a wait on its first curve while the obstacles pass; and the wait, s.
    fn with_yield_stop(
        &self,
        grid: &OccupancyGrid,
        direct: &PlanResult,
        obstacles: &[MovingObstacle],
    ) -> Option<(Trajectory, f64)> {
        let (merged, field) = (self.core.merged(grid).ok()?, self.core.field.as_ref()?);
        let timer = StageTimer::default();
        let query = self.core.query(merged.as_ref().unwrap_or(grid), field, None, &timer);
        with_yield_stop(&query, direct, obstacles)
    }

    /// A plan around the moving obstacles: the cells of each encounter are closed around its time, until the plan has no encounter.
    fn plan_around(
        &mut self,
        grid: &OccupancyGrid,
        obstacles: &[MovingObstacle],
        direct: &PlanResult,
        twist: Twist2,
        goal: Pose2,
    ) -> Option<Box<PlanResult>> {
        const ENCOUNTERS: usize = 4;
        let start = direct.trajectory.points()[0].pose;
        let mut closed = grid.clone();
        let mut time = first_encounter_of(&direct.trajectory, 0.0, obstacles, self.core.shape.radius)?;
        for _ in 0..ENCOUNTERS {
            close_cells(&mut closed, obstacles, time);
            let Plan::Found(around) = self.plan(&closed, start, twist, goal) else { return None };
            match first_encounter_of(&around.trajectory, 0.0, obstacles, self.core.shape.radius) {
                Some(next) => time = next,
                None => return Some(around),
            }
        }
        None
    }
}

mod question;

use crate::body::Body;
use crate::escape::cells_around;
use crate::masks::{cut, kept_out};
use crate::movers::{MAY_GO_ON, Mover, conflict, delayed, stamp};
use crate::plan::{Plan, PlanResult};
use crate::stopwatch::{StageTimes, Stopwatch};
use crate::task::{Memory, Task};
use crate::timing::Drive;
use crate::tour::{Replan, Tour};
use crate::watch::{Exit, Obstruction, deepest, slim, still_free};
use crate::{CurveConfig, DearMask, DistanceField, PlannerConfig, SpeedMask, UnknownIs, WayPointGraph};
use trundle_core::{
    DifferentialDrive, DriveLimits, Footprint, Invalid, OccupancyGrid, Pose2, Trajectory, Twist2,
};

/// The corridor of a lane reaches so far beside it, m: a lane is where the robot is expected.
const LANE: f64 = 0.2;

/// From a grid, a pose and a goal to way-points, a verified curve and a trajectory.
///
/// The robot is the disc about its footprint where that fits, else its outline. Deterministic: the same question gives the
/// same bytes.
#[derive(Debug)]
pub struct Planner {
    config: PlannerConfig,
    /// The same where the robot keeps to lanes.
    on_lanes: PlannerConfig,
    body: Body,
    drive: Drive,
    memory: Memory,
    /// Of the last plan.
    field: Option<DistanceField>,
    /// Of the last plan on cells of half the side.
    fine: Option<DistanceField>,
    keep_out: Option<OccupancyGrid>,
    speeds: Option<SpeedMask>,
    dear: Option<DearMask>,
    clock: Option<fn() -> f64>,
    times: StageTimes,
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
        let drive = Drive {
            limits: limits.validated()?,
            half_base: drive.validated()?.wheelbase / 2.0,
            config: config.timing,
        };
        let (body, memory) = (Body::new(footprint), Memory::default());
        let reach = config.curve.reach.min(LANE);
        let on_lanes = PlannerConfig { curve: CurveConfig { reach, ..config.curve }, ..config };
        Ok(Self {
            config,
            on_lanes,
            body,
            drive,
            memory,
            field: None,
            fine: None,
            keep_out: None,
            speeds: None,
            dear: None,
            clock: None,
            times: StageTimes::default(),
        })
    }

    /// From now on, [`Planner::stage_times`] tells how long plans take, by a clock that counts seconds. Plans do not depend on it.
    pub fn set_clock(&mut self, clock: Option<fn() -> f64>) {
        self.clock = clock;
    }

    /// How long the stages of the last plan took.
    pub fn stage_times(&self) -> StageTimes {
        self.times
    }

    /// From now on, what `mask` has occupied is an obstacle too. The mask may have a resolution and an extent of its own: every
    /// cell of the grid that it touches is forbidden, and beside the grid its cells are.
    pub fn set_keep_out(&mut self, mask: Option<OccupancyGrid>) {
        self.keep_out = mask;
    }

    /// From now on, ways through what is dear on `mask` are taken where they are so much shorter.
    pub fn set_dear(&mut self, mask: Option<DearMask>) {
        self.dear = mask;
    }

    /// From now on, no trajectory is faster than this allows.
    pub fn set_speed_mask(&mut self, mask: Option<SpeedMask>) {
        self.speeds = mask;
    }

    /// Plans from `start`, moving with `start_twist`, to `goal` (map frame), where the robot is to stand.
    ///
    /// A robot that moves forward gets a trajectory that continues its motion; where no curve can, it brakes on its
    /// arc first; where even that has no room, the plan starts from rest and says so.
    pub fn plan(&mut self, grid: &OccupancyGrid, start: Pose2, start_twist: Twist2, goal: Pose2) -> Plan {
        self.plan_on(grid, None, start, start_twist, goal)
    }

    /// Like [`Planner::plan`], along the lanes of a way-point graph: to a node, over free lanes, and from a node to the goal.
    pub fn plan_on_graph(
        &mut self,
        grid: &OccupancyGrid,
        graph: &WayPointGraph,
        start: Pose2,
        start_twist: Twist2,
        goal: Pose2,
    ) -> Plan {
        self.plan_on(grid, Some(graph), start, start_twist, goal)
    }

    /// Plans through `goals` in a row, at rest at each.
    ///
    /// # Errors
    /// Which goal cannot be reached from the one before, and why; goal 0 and a refusal when there is none.
    pub fn plan_tour(
        &mut self,
        grid: &OccupancyGrid,
        start: Pose2,
        start_twist: Twist2,
        goals: &[Pose2],
    ) -> Result<Tour, (usize, Plan)> {
        self.tour(grid, None, (start, start_twist), goals)
    }

    /// [`Planner::plan_tour`], each leg along the lanes of a way-point graph.
    ///
    /// # Errors
    /// As [`Planner::plan_tour`].
    pub fn plan_tour_on_graph(
        &mut self,
        grid: &OccupancyGrid,
        graph: &WayPointGraph,
        start: Pose2,
        start_twist: Twist2,
        goals: &[Pose2],
    ) -> Result<Tour, (usize, Plan)> {
        self.tour(grid, Some(graph), (start, start_twist), goals)
    }

    /// Like [`Planner::plan`], among things that move, each believed to go on as it does for 2 s, and things that stand for now, which are
    /// kept off as obstacles are where there is a way that is not 10 s longer: past them, or after a wait, at the start or, for a robot that
    /// moves, at a stop on its way, whichever arrives earlier. Where both fail, [`Plan::Blocked`] where the robot stands: it should stop.
    pub fn plan_among(
        &mut self,
        grid: &OccupancyGrid,
        movers: &[Mover],
        start: Pose2,
        start_twist: Twist2,
        goal: Pose2,
    ) -> Plan {
        let movers: &[Mover] = &movers.iter().map(|mover| mover.with_margin()).collect::<Vec<_>>();
        let open = match self.plan(grid, start, start_twist, goal) {
            Plan::Found(plan) if movers.iter().any(Mover::stands) => plan.trajectory.duration(),
            Plan::Found(plan) => return self.past(grid, movers, plan, start_twist, goal),
            none => return none,
        };
        if let Some((closed, clear)) =
            self.clear_of_standing(grid, movers, (start, start_twist), (goal, open))
            && let Plan::Found(plan) = self.past(&closed, movers, clear, start_twist, goal)
        {
            return Plan::Found(plan);
        }
        // Once more, for the field of distances is that of another grid now.
        match self.plan(grid, start, start_twist, goal) {
            Plan::Found(plan) => self.past(grid, movers, plan, start_twist, goal),
            none => none,
        }
    }

    /// The plan `direct`, or what of it is best among movers.
    fn past(
        &mut self,
        grid: &OccupancyGrid,
        movers: &[Mover],
        direct: Box<PlanResult>,
        start_twist: Twist2,
        goal: Pose2,
    ) -> Plan {
        let radius = self.body.radius;
        if conflict(&direct.trajectory, 0.0, movers, radius).is_none() {
            return Plan::Found(direct);
        }
        let start = direct.trajectory.points()[0].pose;
        let late = if direct.trajectory.points()[0].twist == Twist2::ZERO {
            delayed(&direct.trajectory, movers, radius)
        } else {
            self.halted(grid, &direct, movers)
        };
        let around = self.plan_around(grid, movers, &direct, start_twist, goal);
        let late = late.map(|(trajectory, wait)| Box::new(PlanResult { trajectory, wait, ..*direct }));
        let earlier = |plan: &PlanResult| plan.trajectory.duration();
        match (around, late) {
            (Some(around), Some(late)) if earlier(&around) <= earlier(&late) => Plan::Found(around),
            (_, Some(late)) => Plan::Found(late),
            (Some(around), None) => Plan::Found(around),
            (None, None) => Plan::Blocked { nearest: start.position() },
        }
    }

    /// The grid closed where something stands among the movers, and a way on it: one that goes on as the robot does, to the goal itself, and
    /// is not so much longer than the `direct` one, s, that waiting until those who stand are believed to stay is sooner.
    fn clear_of_standing(
        &mut self,
        grid: &OccupancyGrid,
        movers: &[Mover],
        (start, twist): (Pose2, Twist2),
        (goal, direct): (Pose2, f64),
    ) -> Option<(OccupancyGrid, Box<PlanResult>)> {
        let standing: Vec<Mover> = movers.iter().filter(|mover| mover.stands()).copied().collect();
        let mut closed = grid.clone();
        stamp(&mut closed, &standing, 0.0);
        let Plan::Found(plan) = self.plan(&closed, start, twist, goal) else { return None };
        let is_good = plan.is_continuous
            && plan.instead_of.is_none()
            && plan.trajectory.duration() < direct + MAY_GO_ON;
        is_good.then_some((closed, plan))
    }

    /// What to do `time` seconds into the plan `current` now that the map, the goal or the movers may have changed: its rest
    /// is kept while it leads to `goal` and stays free; else the new plan starts from its reference, with the reference's
    /// twist, so continuous in position, heading, curvature and speed (see [`PlanResult::is_continuous`]).
    pub fn replan(
        &mut self,
        grid: &OccupancyGrid,
        movers: &[Mover],
        current: &PlanResult,
        time: f64,
        goal: Pose2,
    ) -> Replan {
        let end = current.trajectory.end();
        let same = end.distance(&goal) <= self.config.goal_tolerance.max(1e-2)
            && trundle_core::difference_of_angles(end.theta, goal.theta).abs() < 1e-2;
        let clear = self.meets(&current.trajectory, time, movers).is_none();
        if same && clear && self.still_free(grid, &current.trajectory, time).is_ok() {
            return Replan::Keep;
        }
        let now = current.trajectory.at(time);
        Replan::New(self.plan_among(grid, movers, now.pose, now.twist, goal))
    }

    /// Whether the rest of `trajectory`, from `from` seconds on, is still free on a newer grid, and of the keep-out mask.
    ///
    /// # Errors
    /// The first moment at which the footprint would touch something. One that overlaps something already may go on as long as it
    /// comes no deeper, and near there only, as a plan would that began there.
    pub fn still_free(
        &self,
        grid: &OccupancyGrid,
        trajectory: &Trajectory,
        from: f64,
    ) -> Result<(), Obstruction> {
        let mask = self.keep_out.as_ref().map(|mask| (mask, UnknownIs::Free));
        let layers: Vec<_> = std::iter::once((grid, self.config.unknown)).chain(mask).collect();
        let body = slim(&self.body);
        still_free(&layers, trajectory, from, &body, |pose| self.exit(grid, pose, &body))
    }

    /// How a body leaves what it overlaps at a pose, on the grid and the mask as plans see them.
    fn exit(&self, grid: &OccupancyGrid, pose: Pose2, body: &Body) -> Option<Exit> {
        let around = cells_around(grid.geometry(), pose.position(), deepest(body), body.radius);
        let mut around = cut(grid, around);
        if let Some(mask) = &self.keep_out {
            around = kept_out(&around, mask, false).ok()?;
        }
        Exit::new(&around, self.config.unknown, pose, body)
    }

    /// When the robot, `from` seconds into `trajectory` now, first comes nearer to a mover than both allow, s from now; `None` where
    /// it meets none within 2 s. Microseconds: a question for every scan.
    pub fn meets(&self, trajectory: &Trajectory, from: f64, movers: &[Mover]) -> Option<f64> {
        conflict(trajectory, from, movers, self.body.radius)
    }

    /// The distance field of the last plan, for pictures.
    pub fn field(&self) -> Option<&DistanceField> {
        self.field.as_ref()
    }

    fn tour(
        &mut self,
        grid: &OccupancyGrid,
        graph: Option<&WayPointGraph>,
        (mut from, mut twist): (Pose2, Twist2),
        goals: &[Pose2],
    ) -> Result<Tour, (usize, Plan)> {
        let mut legs: Vec<PlanResult> = Vec::new();
        let mut times = StageTimes::default();
        for (i, goal) in goals.iter().enumerate() {
            match self.plan_on(grid, graph, from, twist, *goal) {
                Plan::Found(leg) => legs.push(*leg),
                other => return Err((i, other)),
            }
            times = times.plus(self.times);
            (from, twist) = (legs[i].trajectory.end(), Twist2::ZERO);
        }
        if legs.is_empty() {
            return Err((0, Plan::Refused(Invalid::new("goals of a tour", 0, "", "1 or more"))));
        }
        self.times = times;
        Ok(Tour::new(legs))
    }

    /// The direct plan with a stop on its first curve, and a wait there, that lets the movers pass; and the wait, s.
    fn halted(
        &self,
        grid: &OccupancyGrid,
        direct: &PlanResult,
        movers: &[Mover],
    ) -> Option<(Trajectory, f64)> {
        let (merged, field) = (self.merged(grid).ok()?, self.field.as_ref()?);
        let watch = Stopwatch::default();
        let task = self.task(merged.as_ref().unwrap_or(grid), field, None, &watch);
        task.halted(direct, movers)
    }

    /// The grid with what is kept out; `None` where that is the grid itself.
    fn merged(&self, grid: &OccupancyGrid) -> Result<Option<OccupancyGrid>, Invalid> {
        self.keep_out.as_ref().map(|mask| kept_out(grid, mask, self.may_leave())).transpose()
    }

    fn task<'a>(
        &'a self,
        grid: &'a OccupancyGrid,
        field: &'a DistanceField,
        graph: Option<&'a WayPointGraph>,
        watch: &'a Stopwatch,
    ) -> Task<'a> {
        Task {
            config: if graph.is_some() { &self.on_lanes } else { &self.config },
            body: &self.body,
            drive: &self.drive,
            field,
            grid,
            speeds: self.speeds.as_ref(),
            dear: self.dear.as_ref(),
            graph,
            watch,
        }
    }

    /// Past the movers: the places of each encounter are closed for a while about its time, until there is none.
    fn plan_around(
        &mut self,
        grid: &OccupancyGrid,
        movers: &[Mover],
        direct: &PlanResult,
        twist: Twist2,
        goal: Pose2,
    ) -> Option<Box<PlanResult>> {
        const ENCOUNTERS: usize = 4;
        let start = direct.trajectory.points()[0].pose;
        let mut closed = grid.clone();
        let mut time = conflict(&direct.trajectory, 0.0, movers, self.body.radius)?;
        for _ in 0..ENCOUNTERS {
            stamp(&mut closed, movers, time);
            let Plan::Found(around) = self.plan(&closed, start, twist, goal) else { return None };
            match conflict(&around.trajectory, 0.0, movers, self.body.radius) {
                Some(next) => time = next,
                None => return Some(around),
            }
        }
        None
    }
}

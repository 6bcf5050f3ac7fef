use crate::area::area;
use crate::plan::{Plan, PlanResult};
use crate::potential::{PotentialField, PotentialKind, PotentialOutcome};
use crate::pull::pull_taut;
use crate::route::{Phase, route, turn};
use crate::space::Space;
use crate::timing::{Drive, trajectory};
use crate::watch::{Obstruction, still_free};
use crate::wave::{Wave, WaveFront};
use crate::{Curve, DistanceField, PlannerConfig, UnknownIs};
use trundle_core::{
    DifferentialDrive, DriveLimits, Footprint, GridGeometry, Invalid, OccupancyGrid, Path, Pose2, Trajectory,
    Twist2, Vector2,
};

/// From a grid, a pose and a goal to way-points, a verified curve and a trajectory.
///
/// The robot is the disc about its footprint. Deterministic: the same question gives the same bytes.
#[derive(Debug)]
pub struct Planner {
    config: PlannerConfig,
    radius: f64,
    drive: Drive,
    wave: WaveFront,
    field: Option<Known>,
}

/// The field of the last plan, and the grid that it came from.
#[derive(Debug)]
struct Known {
    grid: OccupancyGrid,
    field: DistanceField,
}

/// Positions nearer than this are the same place, m.
const SAME_PLACE: f64 = 1e-3;
/// Speeds below this count as standing, m/s.
const STANDING: f64 = 0.01;
/// Beyond this nobody cares how much room there is, m.
const ROOM_CAP: f64 = 2.0;

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
        let radius = footprint.circumscribed_radius();
        Ok(Self { config, radius, drive, wave: WaveFront::default(), field: None })
    }

    /// Plans from `start`, moving with `start_twist`, to `goal` (map frame), where the robot is to stand.
    ///
    /// A robot that moves forward gets a trajectory that continues its motion; where no curve can, it brakes straight on
    /// first; where even that has no room, the plan starts from rest and says so.
    pub fn plan(&mut self, grid: &OccupancyGrid, start: Pose2, start_twist: Twist2, goal: Pose2) -> Plan {
        if let Err(invalid) = finite(start, start_twist, goal) {
            return Plan::Refused(invalid);
        }
        let start = Pose2::new(start.x, start.y, start.theta);
        let goal = Pose2::new(goal.x, goal.y, goal.theta);
        let mut plan = self.plan_within(grid, start, start_twist, goal, 0.0);
        if matches!(plan, Plan::Blocked { .. }) && self.may_leave() {
            let wider = self.plan_within(grid, start, start_twist, goal, self.config.beyond);
            if !matches!(wider, Plan::Refused(_)) {
                plan = wider;
            }
        }
        plan
    }

    /// Whether the rest of `trajectory`, from `from` seconds on, is still free on a newer grid.
    ///
    /// # Errors
    /// The first moment at which the footprint's disc would touch something, unless it touches it already and gets no
    /// nearer.
    pub fn still_free(
        &self,
        grid: &OccupancyGrid,
        trajectory: &Trajectory,
        from: f64,
    ) -> Result<(), Obstruction> {
        still_free(grid, self.config.unknown, trajectory, from, self.radius)
    }

    /// The distance field of the last plan, for pictures.
    pub fn field(&self) -> Option<&DistanceField> {
        self.field.as_ref().map(|known| &known.field)
    }

    fn may_leave(&self) -> bool {
        self.config.unknown == UnknownIs::Free && self.config.beyond > 0.0
    }

    fn plan_within(
        &mut self,
        grid: &OccupancyGrid,
        start: Pose2,
        twist: Twist2,
        goal: Pose2,
        beyond: f64,
    ) -> Plan {
        let geometry = match self.place(grid.geometry(), start.position(), goal.position(), beyond) {
            Ok(geometry) => geometry,
            Err(plan) => return plan,
        };
        let known = self.known(geometry, grid);
        let task =
            Task { config: &self.config, radius: self.radius, drive: &self.drive, field: &known.field, grid };
        let plan = task.plan(&mut self.wave, start, twist, goal);
        self.field = Some(known);
        plan
    }

    /// The field over `geometry`: the last one where nothing changed, else a new one in its memory.
    fn known(&mut self, geometry: GridGeometry, grid: &OccupancyGrid) -> Known {
        match self.field.take() {
            Some(known) if *known.field.geometry() == geometry && known.grid == *grid => known,
            last => {
                let spent = last.map(|known| known.field);
                let field = DistanceField::over(geometry, grid, self.config.unknown, spent);
                Known { grid: grid.clone(), field }
            }
        }
    }

    /// The area to plan in.
    fn place(
        &self,
        grid: &GridGeometry,
        start: Vector2,
        goal: Vector2,
        beyond: f64,
    ) -> Result<GridGeometry, Plan> {
        if !self.may_leave() {
            if grid.cell_at(start).is_none() {
                return Err(Plan::StartOutside);
            }
            return if grid.cell_at(goal).is_none() { Err(Plan::GoalOutside) } else { Ok(*grid) };
        }
        area(grid, start, goal, beyond).map_err(Plan::Refused)
    }
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

/// One question on one field.
struct Task<'a> {
    config: &'a PlannerConfig,
    radius: f64,
    drive: &'a Drive,
    field: &'a DistanceField,
    grid: &'a OccupancyGrid,
}

/// A way on the grid.
struct Way {
    raw: Vec<Vector2>,
    points: Vec<Vector2>,
    fell_back: bool,
}

impl Task<'_> {
    fn plan(&self, wave: &mut WaveFront, start: Pose2, twist: Twist2, goal: Pose2) -> Plan {
        let space = Space::new(self.field, self.grid, self.config.room, self.radius, start.position());
        if let Some(refusal) = self.at_start(start.position()) {
            return refusal;
        }
        if start.distance(&goal) < SAME_PLACE {
            return self.turn_only(start, twist, goal);
        }
        if !self.field.keeps(goal.position(), self.radius) {
            let clearance = self.field.clearance(goal.position(), self.radius) - self.radius;
            return Plan::GoalInObstacle { clearance };
        }
        let way = match self.way(wave, &space, start.position(), goal.position()) {
            Ok(way) => way,
            Err(nearest) => return Plan::Blocked { nearest },
        };
        let shape = &self.config.curve;
        if twist.v > STANDING {
            let curvature = twist.omega / twist.v;
            if let Some(phases) = route(&space, &way.points, start, goal, Some(curvature), shape) {
                return self.timed(way, phases, start, twist.v, true);
            }
            if let Some(plan) = self.brake_first(wave, &space, start, twist, goal) {
                return plan;
            }
        }
        let still = twist.v.abs() <= STANDING;
        let phases = route(&space, &way.points, start, goal, None, shape)
            .expect("invariant: from rest there always is a route along a free way");
        self.timed(way, phases, start, 0.0, still)
    }

    fn at_start(&self, start: Vector2) -> Option<Plan> {
        let room = self.field.clearance(start, self.radius);
        let inside = room <= 0.0 || room < self.radius - self.config.room.escape;
        inside.then_some(Plan::StartInObstacle { clearance: room - self.radius })
    }

    fn turn_only(&self, start: Pose2, twist: Twist2, goal: Pose2) -> Plan {
        let way = Way { raw: vec![start.position()], points: vec![start.position()], fell_back: false };
        let phases = turn(start, start.theta, goal.theta).into_iter().collect();
        self.timed(way, phases, start, 0.0, twist.v.abs() <= STANDING)
    }

    /// Way-points by the potential chosen; the reachable point nearest to the goal when there is no way.
    fn way(
        &self,
        wave: &mut WaveFront,
        space: &Space<'_>,
        start: Vector2,
        goal: Vector2,
    ) -> Result<Way, Vector2> {
        let potential = self.config.potential;
        let mut fell_back = false;
        if potential.kind == PotentialKind::Printed {
            let printed = PotentialField::new(self.field, goal, self.radius, potential);
            if let PotentialOutcome::Reached(raw) = printed.descend(space, start) {
                return Ok(Way { points: pull_taut(space, &raw), raw, fell_back });
            }
            fell_back = true;
        }
        match wave.run(space, start, goal) {
            Wave::Met(raw) => Ok(Way { points: pull_taut(space, &raw), raw, fell_back }),
            Wave::Stuck(nearest) => Err(nearest),
        }
    }

    /// Straight on until it stands, then a plan from there.
    fn brake_first(
        &self,
        wave: &mut WaveFront,
        space: &Space<'_>,
        start: Pose2,
        twist: Twist2,
        goal: Pose2,
    ) -> Option<Plan> {
        let way = twist.v * twist.v / (2.0 * self.drive.limits.acceleration);
        let stop = start.position() + start.direction() * way.max(2.0 * SAME_PLACE);
        if self.field.geometry().cell_at(stop).is_none() || !space.sees(start.position(), stop) {
            return None;
        }
        let standing = Pose2::new(stop.x, stop.y, start.theta);
        let rest = if standing.distance(&goal) < SAME_PLACE {
            Way { raw: vec![stop], points: vec![stop], fell_back: false }
        } else {
            self.way(wave, space, stop, goal.position()).ok()?
        };
        let mut phases = vec![Phase::Drive(Curve::line(start.position(), stop))];
        if rest.points.len() > 1 {
            phases.extend(route(space, &rest.points, standing, goal, None, &self.config.curve)?);
        } else {
            phases.extend(turn(standing, standing.theta, goal.theta));
        }
        let with_start = |mut points: Vec<Vector2>| {
            points.insert(0, start.position());
            points
        };
        let whole =
            Way { raw: with_start(rest.raw), points: with_start(rest.points), fell_back: rest.fell_back };
        Some(self.timed(whole, phases, start, twist.v, twist.omega.abs() <= STANDING))
    }

    fn timed(&self, way: Way, phases: Vec<Phase>, start: Pose2, v: f64, is_continuous: bool) -> Plan {
        let room = |at: Vector2| self.field.distance(at) - self.radius;
        let trajectory = trajectory(start, &phases, v, self.drive, room);
        let min_clearance = self.least_room(&trajectory) - self.radius;
        let lengths = phases.iter().map(|phase| match phase {
            Phase::Drive(curve) => curve.length(),
            Phase::Turn { .. } => 0.0,
        });
        let length = lengths.sum();
        let path = |points| Path::new(points).expect("invariant: way-points are finite");
        Plan::Found(Box::new(PlanResult {
            way_points: path(way.points),
            raw: path(way.raw),
            phases,
            trajectory,
            length,
            min_clearance,
            fell_back: way.fell_back,
            is_continuous,
        }))
    }
    /// The least exact distance of the trajectory's positions from obstacles, m; squares are measured only where the
    /// interpolated distance could make it less.
    fn least_room(&self, trajectory: &Trajectory) -> f64 {
        let surely = self.field.overestimate(self.radius);
        trajectory.points().iter().fold(ROOM_CAP, |least, point| {
            let at = point.pose.position();
            if self.field.distance(at) - surely > least { least } else { self.field.clearance(at, least) }
        })
    }
}

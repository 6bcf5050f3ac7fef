use crate::area::area;
use crate::plan::Plan;
use crate::task::Task;
use crate::timing::Drive;
use crate::watch::{Obstruction, still_free};
use crate::wave::WaveFront;
use crate::{DistanceField, PlannerConfig, UnknownIs};
use trundle_core::{
    DifferentialDrive, DriveLimits, Footprint, GridGeometry, Invalid, OccupancyGrid, Pose2, Trajectory,
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
    /// Of the last plan.
    field: Option<DistanceField>,
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
        let radius = footprint.circumscribed_radius();
        Ok(Self { config, radius, drive, wave: WaveFront::default(), field: None })
    }

    /// Plans from `start`, moving with `start_twist`, to `goal` (map frame), where the robot is to stand.
    ///
    /// A robot that moves forward gets a trajectory that continues its motion; where no curve can, it brakes on its
    /// arc first; where even that has no room, the plan starts from rest and says so.
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
        self.field.as_ref()
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
        let field = self.known(geometry, grid);
        let task =
            Task { config: &self.config, radius: self.radius, drive: &self.drive, field: &field, grid };
        let plan = task.plan(&mut self.wave, start, twist, goal);
        self.field = Some(field);
        plan
    }

    /// The field over `geometry`: the last one, brought up to date, where it lies there.
    fn known(&mut self, geometry: GridGeometry, grid: &OccupancyGrid) -> DistanceField {
        match self.field.take() {
            Some(mut field) if *field.geometry() == geometry => {
                field.update(grid);
                field
            }
            _ => DistanceField::over(geometry, grid, self.config.unknown),
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

//! A question to the planner: where it is asked, on which cells, and on which fields.

use super::Planner;
use crate::area::area;
use crate::finer::finer;
use crate::plan::{Plan, ROOM_CAP};
use crate::stopwatch::{StageTimes, Stopwatch};
use crate::task::Memory;
use crate::{DistanceField, PlannerConfig, PotentialKind, UnknownIs, WayPointGraph};
use trundle_core::{GridGeometry, Invalid, OccupancyGrid, Pose2, Twist2};

/// What is asked of a planner.
#[derive(Clone, Copy)]
struct Question<'a> {
    graph: Option<&'a WayPointGraph>,
    start: Pose2,
    twist: Twist2,
    goal: Pose2,
}

impl Planner {
    pub(super) fn plan_on(
        &mut self,
        grid: &OccupancyGrid,
        graph: Option<&WayPointGraph>,
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
        self.times = StageTimes::default();
        let wrapped = |pose: Pose2| Pose2::new(pose.x, pose.y, pose.theta);
        let q = Question { graph, start: wrapped(start), twist, goal: wrapped(goal) };
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

    fn plan_within(&mut self, grid: &OccupancyGrid, q: Question<'_>, beyond: f64) -> Plan {
        let geometry = match self.place(grid.geometry(), q, beyond) {
            Ok(geometry) => geometry,
            Err(plan) => return plan,
        };
        let watch = Stopwatch::new(self.clock);
        let last = self.field.take();
        let field = watch.time(|times| &mut times.field, || self.known(last, geometry, grid));
        let mut memory = std::mem::take(&mut self.memory);
        let task = self.task(grid, &field, q.graph, &watch);
        let mut plan = task.plan(&mut memory, q.start, q.twist, q.goal);
        if task.may_be_tight(&mut memory, &plan, q.start, q.goal) {
            let fine = self.plan_finely(grid, q, &mut memory, &watch, beyond);
            plan = fine.filter(|fine| fine.ends_nearer(&plan, q.goal)).unwrap_or(plan);
        }
        self.memory = memory;
        self.field = Some(field);
        self.times = self.times.plus(watch.times());
        plan
    }

    /// On a lattice twice as fine; `None` where that would be out of proportion.
    fn plan_finely(
        &mut self,
        grid: &OccupancyGrid,
        q: Question<'_>,
        memory: &mut Memory,
        watch: &Stopwatch,
        beyond: f64,
    ) -> Option<Plan> {
        let fine = finer(grid)?;
        let geometry = self.place(fine.geometry(), q, beyond).ok()?;
        let last = self.fine.take();
        let field = watch.time(|times| &mut times.field, || self.known(last, geometry, &fine));
        let plan = self.task(&fine, &field, q.graph, watch).plan(memory, q.start, q.twist, q.goal);
        self.fine = Some(field);
        Some(plan)
    }

    /// The field over `geometry`: the last one, brought up to date, where it lies there.
    fn known(
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

    /// The longest distance to an obstacle that makes a difference to a plan, m, and cells to interpolate between.
    fn reach(&self, resolution: f64) -> f64 {
        let PlannerConfig { room, potential, timing, .. } = self.config;
        let wanted = [room.comfort, room.margin, timing.full_speed_clearance, ROOM_CAP];
        let reach = if potential.kind == PotentialKind::Printed { potential.reach } else { 0.0 };
        self.body.radius + wanted.into_iter().fold(reach, f64::max) + 4.0 * resolution
    }

    /// The area to plan in.
    fn place(&self, grid: &GridGeometry, q: Question<'_>, beyond: f64) -> Result<GridGeometry, Plan> {
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

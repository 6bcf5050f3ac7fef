//! One question, answered on one distance field: way-points, phases, timing.

use crate::body::Body;
use crate::graph::WayPointGraph;
use crate::maneuver::Maneuver;
use crate::masks::{DearMask, SpeedMask, is_unseen};
use crate::outline::DEEPEST;
use crate::plan::{Plan, PlanResult, ROOM_CAP};
use crate::route::{Course, Phase, is_drivable, route, turn};
use crate::space::Space;
use crate::stopwatch::Stopwatch;
use crate::timing::{Drive, can_follow, trajectory};
use crate::wave::{Wave, WaveFront};
use crate::way::Way;
use crate::{Curve, DistanceField, PlannerConfig};
use trundle_core::{OccupancyGrid, Path, Pose2, Trajectory, Twist2, Vector2};

/// Positions nearer than this are the same place, m.
pub(crate) const SAME_PLACE: f64 = 1e-3;
/// Speeds below this count as standing, m/s.
pub(crate) const STANDING: f64 = 0.01;
/// The least radius that a search counts with, m: an axle outside the outline has no room of its own.
pub(crate) const LEAST_RADIUS: f64 = 0.01;

/// One question on one field.
pub(crate) struct Task<'a> {
    pub(crate) config: &'a PlannerConfig,
    pub(crate) body: &'a Body,
    pub(crate) drive: &'a Drive,
    pub(crate) field: &'a DistanceField,
    pub(crate) grid: &'a OccupancyGrid,
    pub(crate) speeds: Option<&'a SpeedMask>,
    pub(crate) dear: Option<&'a DearMask>,
    pub(crate) graph: Option<&'a WayPointGraph>,
    pub(crate) watch: &'a Stopwatch,
}

/// What searches remember from plan to plan: their buffers.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    pub(crate) wave: WaveFront,
    pub(crate) maneuver: Maneuver,
}

impl Task<'_> {
    /// Way, curve and timing, or why there is none: for the disc about the robot first, and where that does not fit, for
    /// its outline.
    pub(crate) fn plan(&self, memory: &mut Memory, start: Pose2, twist: Twist2, goal: Pose2) -> Plan {
        if start.distance(&goal) < SAME_PLACE && (self.body.is_disc() || self.fits(start)) {
            return self.at_start(start.position()).unwrap_or_else(|| self.turn_only(start, twist, goal));
        }
        if !self.body.is_disc() && !self.fits(start) {
            return self.plan_out(memory, start, twist, goal);
        }
        self.plan_somehow(memory, start, twist, goal)
    }

    /// For an outline that overlaps something, not deeper than it may be planned out of.
    fn plan_out(&self, memory: &mut Memory, start: Pose2, twist: Twist2, goal: Pose2) -> Plan {
        let escape = self.config.room.escape;
        let depth = self.body.overlap(self.field, start, escape.max(DEEPEST));
        let leaving = (depth <= escape).then(|| self.body.leaving(self.field, start, depth)).flatten();
        match leaving {
            Some(body) if body.gap(self.field, start, 1e-3) > 0.0 => {
                Task { body: &body, ..*self }.plan_somehow(memory, start, twist, goal)
            }
            _ => Plan::StartInObstacle { clearance: -depth },
        }
    }

    fn plan_somehow(&self, memory: &mut Memory, start: Pose2, twist: Twist2, goal: Pose2) -> Plan {
        let tolerance = self.config.goal_tolerance;
        if self.body.is_disc() {
            return self.plan_disc(&mut memory.wave, start, twist, goal, tolerance);
        }
        let plan = self.plan_disc(&mut memory.wave, start, twist, goal, 0.0);
        if matches!(plan, Plan::Found(_)) {
            return plan;
        }
        let plan = self.plan_outline(memory, start, twist, goal, &plan);
        if matches!(plan, Plan::Found(_)) || tolerance == 0.0 {
            return plan;
        }
        match self.plan_disc(&mut memory.wave, start, twist, goal, tolerance) {
            Plan::Found(mut nearby) => {
                nearby.instead_of = Some(plan);
                Plan::Found(nearby)
            }
            _ => plan,
        }
    }

    pub(crate) fn space(&self, radius: f64, start: Vector2) -> Space<'_> {
        let space = Space::new(self.field, self.grid, self.config.room, radius, start).with_dear(self.dear);
        if self.body.is_disc() { space.keeping_off_the_rest(start) } else { space }
    }

    pub(crate) fn course<'b>(&'b self, space: &'b Space<'b>) -> Course<'b> {
        let body = (!self.body.is_disc()).then_some(self.body);
        Course { space, body, config: &self.config.curve }
    }

    /// To the goal, or to the reachable place nearest to it, at most `tolerance` m off.
    fn plan_disc(
        &self,
        wave: &mut WaveFront,
        start: Pose2,
        twist: Twist2,
        goal: Pose2,
        tolerance: f64,
    ) -> Plan {
        if let Some(refusal) = self.at_start(start.position()) {
            return refusal;
        }
        let radius = self.body.radius;
        let space = self.space(radius, start.position());
        let fits = self.field.keeps(goal.position(), radius);
        let clearance = || self.field.clearance(goal.position(), radius) - radius;
        if !fits && tolerance == 0.0 {
            return Plan::GoalInObstacle { clearance: clearance() };
        }
        let nearest = match self.way(wave, &space, start.position(), goal.position()) {
            Ok(way) => return self.on_way(wave, &space, way, (start, twist), goal),
            Err(nearest) => nearest,
        };
        if (nearest - goal.position()).norm() > tolerance {
            return Plan::Blocked { nearest };
        }
        let instead = Pose2::new(nearest.x, nearest.y, goal.theta);
        let plan = if start.distance(&instead) < SAME_PLACE {
            self.turn_only(start, twist, instead)
        } else {
            match self.way(wave, &space, start.position(), nearest) {
                Ok(way) => self.on_way(wave, &space, way, (start, twist), instead),
                Err(nearest) => Plan::Blocked { nearest },
            }
        };
        let Plan::Found(mut plan) = plan else { return plan };
        let refusal =
            if fits { Plan::Blocked { nearest } } else { Plan::GoalInObstacle { clearance: clearance() } };
        plan.instead_of = Some(refusal);
        Plan::Found(plan)
    }

    /// Along a way: on from the motion under way, or after braking, or from rest.
    fn on_way(
        &self,
        wave: &mut WaveFront,
        space: &Space<'_>,
        way: Way,
        (start, twist): (Pose2, Twist2),
        goal: Pose2,
    ) -> Plan {
        let course = self.course(space);
        if twist.v > STANDING {
            let onward = self.route(&course, &way.points, start, goal, Some(twist.omega / twist.v));
            if let Some(phases) = onward.filter(|phases| can_follow(phases, twist.v, self.drive)) {
                return self.timed(way, phases, start, twist.v, true);
            }
            if let Some(plan) = self.brake_first(wave, &course, start, twist, goal) {
                return plan;
            }
        }
        let still = twist.v.abs() <= STANDING;
        match self.route(&course, &way.points, start, goal, None) {
            Some(phases) => self.timed(way, phases, start, 0.0, still),
            // An outline that escapes from a wall, or turns beside it, may touch what its disc would not.
            None => Plan::Blocked { nearest: start.position() },
        }
    }

    /// Whether a way that the lattice does not see may lead to the goal, or near enough to one that does not fit: every point of one
    /// lies within half a cell's diagonal of a centre, which has so much less room at least. Of discs; also along a graph, whose
    /// ways are ways.
    pub(crate) fn may_be_tight(&self, memory: &mut Memory, plan: &Plan, start: Pose2, goal: Pose2) -> bool {
        if !self.body.is_disc() || !plan.falls_short() {
            return false;
        }
        let off = self.field.geometry().resolution * std::f64::consts::FRAC_1_SQRT_2;
        let less = (self.body.radius - off).max(LEAST_RADIUS);
        let (start, goal) = (start.position(), goal.position());
        let space = Space::new(self.field, self.grid, self.config.room, less, start);
        match memory.wave.run(&space, start, goal) {
            Wave::Met(_) => true,
            Wave::Stuck(nearest) => {
                let (tolerance, is_blocked) =
                    (self.config.goal_tolerance, matches!(plan, Plan::Blocked { .. }));
                is_blocked && tolerance > 0.0 && (nearest - goal).norm() <= tolerance + off
            }
        }
    }

    /// Whether the outline touches nothing.
    pub(crate) fn fits(&self, pose: Pose2) -> bool {
        self.body.gap(self.field, pose, 1e-3) > 0.0
    }

    /// Why the disc cannot set out from here.
    fn at_start(&self, start: Vector2) -> Option<Plan> {
        if !self.body.is_disc() {
            return None;
        }
        let radius = self.body.radius;
        let room = self.field.clearance(start, radius);
        let inside = room <= 0.0 || room < radius - self.config.room.escape;
        inside.then_some(Plan::StartInObstacle { clearance: room - radius })
    }

    fn turn_only(&self, start: Pose2, twist: Twist2, goal: Pose2) -> Plan {
        let way = Way::new(vec![start.position()], vec![start.position()]);
        let space = self.space(self.body.inner.max(LEAST_RADIUS), start.position());
        match turn(&self.course(&space), start, start.theta, goal.theta) {
            Some(phase) => {
                self.timed(way, phase.into_iter().collect(), start, 0.0, twist.v.abs() <= STANDING)
            }
            None => Plan::Blocked { nearest: start.position() },
        }
    }

    /// [`route`], on the clock.
    pub(crate) fn route(
        &self,
        course: &Course<'_>,
        way: &[Vector2],
        start: Pose2,
        goal: Pose2,
        moving: Option<f64>,
    ) -> Option<Vec<Phase>> {
        self.watch.time(|times| &mut times.curve, || route(course, way, start, goal, moving))
    }

    /// On along the present arc until it stands, then a plan from there.
    fn brake_first(
        &self,
        wave: &mut WaveFront,
        course: &Course<'_>,
        start: Pose2,
        twist: Twist2,
        goal: Pose2,
    ) -> Option<Plan> {
        let brake = self.brake(start, twist);
        let standing = brake.pose(brake.span());
        let stop = standing.position();
        let inside = self.field.geometry().cell_at(stop).is_some();
        if !inside || !is_drivable(course, &brake) {
            return None;
        }
        let rest = if standing.distance(&goal) < SAME_PLACE {
            Way::new(vec![stop], vec![stop])
        } else {
            self.way(wave, course.space, stop, goal.position()).ok()?
        };
        let mut phases = vec![Phase::Drive(brake)];
        if rest.points.len() > 1 {
            phases.extend(self.route(course, &rest.points, standing, goal, None)?);
        } else {
            phases.extend(turn(course, standing, standing.theta, goal.theta)?);
        }
        let with_start = |mut points: Vec<Vector2>| {
            points.insert(0, start.position());
            points
        };
        let whole =
            Way { raw: with_start(rest.raw), points: with_start(rest.points), fell_back: rest.fell_back };
        Some(self.timed(whole, phases, start, twist.v, true))
    }

    /// The arc on which the robot comes to rest as fast as timing allows.
    pub(crate) fn brake(&self, start: Pose2, twist: Twist2) -> Curve {
        let curvature = twist.omega / twist.v;
        let deceleration = self.drive.acceleration(curvature);
        let length = twist.v * twist.v / (2.0 * deceleration);
        // A little longer than exact: the quintic is a little shorter than the arc.
        Curve::arc(start, curvature, (length * 1.001).max(2.0 * SAME_PLACE))
    }

    pub(crate) fn timed(
        &self,
        way: Way,
        phases: Vec<Phase>,
        start: Pose2,
        v: f64,
        is_continuous: bool,
    ) -> Plan {
        let timing = || trajectory(start, &phases, v, self.drive, |pose| self.ceiling(pose));
        let trajectory = self.watch.time(|times| &mut times.timing, timing);
        let min_clearance = self.watch.time(|times| &mut times.curve, || self.least_room(&trajectory));
        let lengths = phases.iter().map(|phase| match phase {
            Phase::Drive(curve) => curve.length(),
            Phase::Turn { .. } => 0.0,
        });
        let length = lengths.fold(0.0, |sum, length| sum + length);
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
            instead_of: None,
            wait: 0.0,
        }))
    }

    /// The highest speed at a pose for what surrounds it, m/s: room, what was never seen, and the mask.
    pub(crate) fn ceiling(&self, pose: Pose2) -> f64 {
        let at = pose.position();
        let room = self.drive.near_obstacles(self.field.distance(at) - self.body.radius);
        let unseen = is_unseen(self.grid, pose, self.body.radius);
        let seen = if unseen { self.drive.config.unknown_speed } else { f64::INFINITY };
        room.min(seen).min(self.speeds.map_or(f64::INFINITY, |mask| mask.limit(at)))
    }

    /// The least exact room beside the robot along the trajectory, m; squares are measured only where the interpolated
    /// distance could make it less.
    fn least_room(&self, trajectory: &Trajectory) -> f64 {
        if self.body.depth() > 0.0 {
            return -self.body.depth();
        }
        let radius = self.body.radius;
        let surely = self.field.overestimate(radius);
        trajectory.points().iter().fold(ROOM_CAP, |least, point| {
            let at = point.pose.position();
            if self.field.distance(at) - surely - radius > least {
                least
            } else if self.body.is_disc() {
                self.field.clearance(at, least + radius) - radius
            } else {
                self.body.gap(self.field, point.pose, least)
            }
        })
    }
}

//! One question, answered on one distance field: way-points, phases, timing.

use crate::body::Body;
use crate::graph::WayPointGraph;
use crate::maneuver::Maneuver;
use crate::masks::{SpeedMask, is_unseen};
use crate::plan::{Plan, PlanResult};
use crate::potential::{PotentialField, PotentialKind, PotentialOutcome};
use crate::pull::pull_taut;
use crate::route::{Course, Phase, is_drivable, route, straight, turn};
use crate::space::Space;
use crate::timing::{Drive, can_follow, trajectory};
use crate::wave::{Wave, WaveFront};
use crate::{Curve, DistanceField, PlannerConfig};
use trundle_core::{OccupancyGrid, Path, Pose2, Trajectory, Twist2, Vector2};

/// Positions nearer than this are the same place, m.
const SAME_PLACE: f64 = 1e-3;
/// Speeds below this count as standing, m/s.
const STANDING: f64 = 0.01;
/// Beyond this nobody cares how much room there is, m.
const ROOM_CAP: f64 = 2.0;
/// The least radius that a search counts with, m: an axle outside the outline has no room of its own.
const LEAST_RADIUS: f64 = 0.01;

/// Nodes of a way-point graph that are tried as the first, and as the last.
const DOORS: usize = 3;

/// One question on one field.
pub(crate) struct Task<'a> {
    pub(crate) config: &'a PlannerConfig,
    pub(crate) body: &'a Body,
    pub(crate) drive: &'a Drive,
    pub(crate) field: &'a DistanceField,
    pub(crate) grid: &'a OccupancyGrid,
    pub(crate) speeds: Option<&'a SpeedMask>,
    pub(crate) graph: Option<&'a WayPointGraph>,
}

/// What searches remember from plan to plan: their buffers.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    wave: WaveFront,
    maneuver: Maneuver,
}

/// A way on the grid.
struct Way {
    raw: Vec<Vector2>,
    points: Vec<Vector2>,
    fell_back: bool,
}

impl Way {
    fn new(raw: Vec<Vector2>, points: Vec<Vector2>) -> Self {
        Self { raw, points, fell_back: false }
    }

    /// Goes on with another that begins where this one ends.
    fn extend(&mut self, next: Self) {
        self.raw.extend(next.raw.into_iter().skip(1));
        self.points.extend(next.points.into_iter().skip(1));
        self.fell_back |= next.fell_back;
    }
}

impl Task<'_> {
    /// Way, curve and timing, or why there is none: for the disc about the robot first, and where that does not fit, for
    /// its outline.
    pub(crate) fn plan(&self, memory: &mut Memory, start: Pose2, twist: Twist2, goal: Pose2) -> Plan {
        if start.distance(&goal) < SAME_PLACE && (self.body.is_disc() || self.fits(start)) {
            return self.at_start(start.position()).unwrap_or_else(|| self.turn_only(start, twist, goal));
        }
        let plan = self.plan_disc(&mut memory.wave, start, twist, goal);
        if self.body.is_disc() || matches!(plan, Plan::Found(_)) {
            return plan;
        }
        self.plan_outline(&mut memory.maneuver, start, twist, goal)
    }

    fn space(&self, radius: f64, start: Vector2) -> Space<'_> {
        Space::new(self.field, self.grid, self.config.room, radius, start)
    }

    fn course<'b>(&'b self, space: &'b Space<'b>) -> Course<'b> {
        let body = (!self.body.is_disc()).then_some(self.body);
        Course { space, body, config: &self.config.curve }
    }

    fn plan_disc(&self, wave: &mut WaveFront, start: Pose2, twist: Twist2, goal: Pose2) -> Plan {
        if let Some(refusal) = self.at_start(start.position()) {
            return refusal;
        }
        let radius = self.body.radius;
        let space = self.space(radius, start.position());
        let tolerance = self.config.goal_tolerance;
        if tolerance == 0.0 && !self.field.keeps(goal.position(), radius) {
            let clearance = self.field.clearance(goal.position(), radius) - radius;
            return Plan::GoalInObstacle { clearance };
        }
        let found = self.way(wave, &space, start.position(), goal.position());
        let (way, goal) = match found {
            Ok(way) => (way, goal),
            Err(nearest) if (nearest - goal.position()).norm() > tolerance => {
                return Plan::Blocked { nearest };
            }
            Err(nearest) => {
                let instead = Pose2::new(nearest.x, nearest.y, goal.theta);
                if start.distance(&instead) < SAME_PLACE {
                    return self.turn_only(start, twist, instead);
                }
                match self.way(wave, &space, start.position(), nearest) {
                    Ok(way) => (way, instead),
                    Err(nearest) => return Plan::Blocked { nearest },
                }
            }
        };
        let course = self.course(&space);
        if twist.v > STANDING {
            let onward = route(&course, &way.points, start, goal, Some(twist.omega / twist.v));
            if let Some(phases) = onward.filter(|phases| can_follow(phases, twist.v, self.drive)) {
                return self.timed(way, phases, start, twist.v, true);
            }
            if let Some(plan) = self.brake_first(wave, &course, start, twist, goal) {
                return plan;
            }
        }
        let still = twist.v.abs() <= STANDING;
        match route(&course, &way.points, start, goal, None) {
            Some(phases) => self.timed(way, phases, start, 0.0, still),
            // An outline that escapes from a wall, or turns beside it, may touch what its disc would not.
            None => Plan::Blocked { nearest: start.position() },
        }
    }

    /// From rest, by straight moves and turns of the outline; along a curve where one is free.
    fn plan_outline(&self, maneuver: &mut Maneuver, start: Pose2, twist: Twist2, goal: Pose2) -> Plan {
        let inner = self.body.inner.max(LEAST_RADIUS);
        let missing = |at: Vector2| (self.field.clearance(at, inner) - inner).min(0.0);
        if !self.fits(start) {
            return Plan::StartInObstacle { clearance: missing(start.position()) };
        }
        if !self.fits(goal) {
            return Plan::GoalInObstacle { clearance: missing(goal.position()) };
        }
        let space = self.space(inner, start.position());
        let poses = match maneuver.run(&space, self.body, start, goal) {
            Ok(poses) => poses,
            Err(nearest) => return Plan::Blocked { nearest },
        };
        let raw: Vec<Vector2> = poses.iter().map(Pose2::position).collect();
        let poses = crate::maneuver::shortened(&space, self.body, &poses);
        let mut points: Vec<Vector2> = poses.iter().map(Pose2::position).collect();
        points.dedup_by(|a, b| (*a - *b).norm() < SAME_PLACE);
        let course = self.course(&space);
        let along = (points.len() > 1).then(|| route(&course, &points, start, goal, None)).flatten();
        match along.or_else(|| straight(&course, &poses)) {
            Some(phases) => self.timed(Way::new(raw, points), phases, start, 0.0, twist.v.abs() <= STANDING),
            None => Plan::Blocked { nearest: start.position() },
        }
    }

    /// Whether the outline touches nothing.
    fn fits(&self, pose: Pose2) -> bool {
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

    /// The way to the goal: over the way-point graph where there is one.
    fn way(
        &self,
        wave: &mut WaveFront,
        space: &Space<'_>,
        start: Vector2,
        goal: Vector2,
    ) -> Result<Way, Vector2> {
        let Some(graph) = self.graph else { return self.leg(wave, space, start, goal) };
        let (enter, leave) = (graph.nearest(start), graph.nearest(goal));
        let ends = enter.iter().take(DOORS).flat_map(|a| leave.iter().take(DOORS).map(move |b| (*a, *b)));
        let mut failure = start;
        for (first, last) in ends {
            let Some(nodes) = graph.way(first, last, |a, b| space.sees(a, b)) else { continue };
            match self.legs(wave, space, start, nodes.iter().map(|node| graph.nodes()[*node]), goal) {
                Ok(way) => return Ok(way),
                Err(nearest) => failure = nearest,
            }
        }
        Err(failure)
    }

    /// Through nodes that see each other.
    fn legs(
        &self,
        wave: &mut WaveFront,
        space: &Space<'_>,
        start: Vector2,
        nodes: impl Iterator<Item = Vector2>,
        goal: Vector2,
    ) -> Result<Way, Vector2> {
        let mut way = Way::new(vec![start], vec![start]);
        for (i, node) in nodes.enumerate() {
            let here = way.points[way.points.len() - 1];
            if (node - here).norm() < SAME_PLACE {
                continue;
            }
            let lane = || Way::new(vec![here, node], vec![here, node]);
            way.extend(if i > 0 { lane() } else { self.leg(wave, space, here, node)? });
        }
        let here = way.points[way.points.len() - 1];
        if (goal - here).norm() > SAME_PLACE {
            way.extend(self.leg(wave, space, here, goal)?);
        }
        Ok(way)
    }

    /// Way-points by the potential chosen; the reachable point nearest to the goal when there is no way.
    fn leg(
        &self,
        wave: &mut WaveFront,
        space: &Space<'_>,
        start: Vector2,
        goal: Vector2,
    ) -> Result<Way, Vector2> {
        let potential = self.config.potential;
        let mut fell_back = false;
        if potential.kind == PotentialKind::Printed {
            let printed = PotentialField::new(self.field, goal, self.body.radius, potential);
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
            phases.extend(route(course, &rest.points, standing, goal, None)?);
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
    fn brake(&self, start: Pose2, twist: Twist2) -> Curve {
        let curvature = twist.omega / twist.v;
        let deceleration = self.drive.acceleration(curvature);
        let length = twist.v * twist.v / (2.0 * deceleration);
        // A little longer than exact: the quintic is a little shorter than the arc.
        Curve::arc(start, curvature, (length * 1.001).max(2.0 * SAME_PLACE))
    }

    fn timed(&self, way: Way, phases: Vec<Phase>, start: Pose2, v: f64, is_continuous: bool) -> Plan {
        let trajectory = trajectory(start, &phases, v, self.drive, |pose| self.ceiling(pose));
        let min_clearance = self.least_room(&trajectory);
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
            wait: 0.0,
        }))
    }

    /// The highest speed at a pose for what surrounds it, m/s: room, what was never seen, and the mask.
    fn ceiling(&self, pose: Pose2) -> f64 {
        let at = pose.position();
        let room = self.drive.near_obstacles(self.field.distance(at) - self.body.radius);
        let unseen = is_unseen(self.grid, pose, self.body.radius);
        let seen = if unseen { self.drive.config.unknown_speed } else { f64::INFINITY };
        room.min(seen).min(self.speeds.map_or(f64::INFINITY, |mask| mask.limit(at)))
    }

    /// The least exact room beside the robot along the trajectory, m; squares are measured only where the interpolated
    /// distance could make it less.
    fn least_room(&self, trajectory: &Trajectory) -> f64 {
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

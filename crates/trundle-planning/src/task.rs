//! One question, answered on one distance field: way-points, phases, timing.

use crate::plan::{Plan, PlanResult};
use crate::potential::{PotentialField, PotentialKind, PotentialOutcome};
use crate::pull::pull_taut;
use crate::route::{Phase, is_drivable, route, turn};
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

/// One question on one field.
pub(crate) struct Task<'a> {
    pub(crate) config: &'a PlannerConfig,
    pub(crate) radius: f64,
    pub(crate) drive: &'a Drive,
    pub(crate) field: &'a DistanceField,
    pub(crate) grid: &'a OccupancyGrid,
}

/// A way on the grid.
struct Way {
    raw: Vec<Vector2>,
    points: Vec<Vector2>,
    fell_back: bool,
}

impl Task<'_> {
    /// Way, curve and timing, or why there is none.
    pub(crate) fn plan(&self, wave: &mut WaveFront, start: Pose2, twist: Twist2, goal: Pose2) -> Plan {
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
            let onward = route(&space, &way.points, start, goal, Some(curvature), shape);
            if let Some(phases) = onward.filter(|phases| can_follow(phases, twist.v, self.drive)) {
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

    /// On along the present arc until it stands, then a plan from there.
    fn brake_first(
        &self,
        wave: &mut WaveFront,
        space: &Space<'_>,
        start: Pose2,
        twist: Twist2,
        goal: Pose2,
    ) -> Option<Plan> {
        let brake = self.brake(start, twist);
        let standing = brake.pose(brake.span());
        let stop = standing.position();
        let inside = self.field.geometry().cell_at(stop).is_some();
        if !inside || !is_drivable(space, &brake, self.config.curve.max_curvature) {
            return None;
        }
        let rest = if standing.distance(&goal) < SAME_PLACE {
            Way { raw: vec![stop], points: vec![stop], fell_back: false }
        } else {
            self.way(wave, space, stop, goal.position()).ok()?
        };
        let mut phases = vec![Phase::Drive(brake)];
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
        let room = |at: Vector2| self.field.distance(at) - self.radius;
        let trajectory = trajectory(start, &phases, v, self.drive, room);
        let min_clearance = self.least_room(&trajectory) - self.radius;
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

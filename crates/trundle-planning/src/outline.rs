//! Plans for an outline where the disc about it does not fit.

use crate::maneuver::{Maneuver, shortened};
use crate::plan::Plan;
use crate::route::{Course, Phase, is_drivable, straight};
use crate::space::Space;
use crate::task::{LEAST_RADIUS, Memory, SAME_PLACE, STANDING, Task};
use crate::timing::can_follow;
use crate::wave::{Wave, WaveFront};
use crate::way::Way;
use trundle_core::{Pose2, Twist2, Vector2};

/// An overlap is measured up to here, or to the axle, m.
pub(crate) const DEEPEST: f64 = 0.2;

/// What a motion may overlap unnoticed, m.
const ROUNDING: f64 = 1e-3;

/// How an outline gets to the goal.
struct Moves {
    poses: Vec<Pose2>,
    way: Way,
}

impl Task<'_> {
    /// By straight moves and turns of the outline; along a curve where one is free. A robot under way goes on along a curve
    /// that continues its motion, or brakes on its arc first; where neither is free, the plan starts from rest and says so.
    /// `by_disc`: what became of the disc about it.
    pub(crate) fn plan_outline(
        &self,
        memory: &mut Memory,
        start: Pose2,
        twist: Twist2,
        goal: Pose2,
        by_disc: &Plan,
    ) -> Plan {
        let inner = self.body.inner.max(LEAST_RADIUS);
        let missing = |pose: Pose2| -self.body.overlap(self.field, pose, self.body.inner.max(DEEPEST));
        if !self.fits(start) {
            return Plan::StartInObstacle { clearance: missing(start) };
        }
        if !self.fits(goal) {
            return Plan::GoalInObstacle { clearance: missing(goal) };
        }
        if self.is_shut_off(&mut memory.wave, start, goal) {
            return match by_disc {
                Plan::Blocked { .. } => by_disc.clone(),
                _ => Plan::Blocked { nearest: self.nearest(&mut memory.wave, start, goal) },
            };
        }
        let space = self.space(inner, start.position());
        let course = self.course(&space);
        let maneuver = &mut memory.maneuver;
        let moves = match self.moves(maneuver, &course, start, goal) {
            Ok(moves) => moves,
            Err(nearest) => return Plan::Blocked { nearest },
        };
        if twist.v > STANDING {
            let onward = self.along(&course, &moves, start, goal, Some(twist.omega / twist.v));
            if let Some(phases) = onward.filter(|phases| can_follow(phases, twist.v, self.drive)) {
                return self.timed(moves.way, phases, start, twist.v, true);
            }
            if let Some(plan) = self.brake_outline(maneuver, &course, start, twist, goal) {
                return plan;
            }
        }
        match self.phases(&course, &moves, start, goal) {
            Some(phases) => self.timed(moves.way, phases, start, 0.0, twist.v.abs() <= STANDING),
            None => Plan::Blocked { nearest: start.position() },
        }
    }

    /// Whether not even the largest disc inside the outline gets through, by half a cell's diagonal smaller, as it would on any way
    /// between the centres: quickly told, where the search over headings would look everywhere.
    fn is_shut_off(&self, wave: &mut WaveFront, start: Pose2, goal: Pose2) -> bool {
        let geometry = self.field.geometry();
        let (middle, radius) = self.body.inscribed;
        let off = geometry.resolution * std::f64::consts::FRAC_1_SQRT_2;
        let less = radius - self.body.depth() - off - ROUNDING;
        let (from, to) = (start.transform(middle), goal.transform(middle));
        let is_inside = [from, to].iter().all(|at| geometry.cell_at(*at).is_some());
        if less < LEAST_RADIUS || !is_inside {
            return false;
        }
        let space = Space::new(self.field, self.grid, self.config.room, less, from);
        matches!(wave.run(&space, from, to), Wave::Stuck(_))
    }

    /// The place nearest to the goal that the disc about the outline reaches.
    fn nearest(&self, wave: &mut WaveFront, start: Pose2, goal: Pose2) -> Vector2 {
        let space = self.space(self.body.radius, start.position());
        match wave.run(&space, start.position(), goal.position()) {
            Wave::Stuck(nearest) => nearest,
            Wave::Met(_) => goal.position(),
        }
    }

    /// The search's way, or the reachable point nearest to the goal.
    fn moves(
        &self,
        maneuver: &mut Maneuver,
        course: &Course<'_>,
        start: Pose2,
        goal: Pose2,
    ) -> Result<Moves, Vector2> {
        let search = || maneuver.run(course.space, self.body, start, goal);
        let poses = self.watch.time(|times| &mut times.way_points, search)?;
        let raw: Vec<Vector2> = poses.iter().map(Pose2::position).collect();
        let poses = shortened(course.space, self.body, &poses);
        let mut points: Vec<Vector2> = poses.iter().map(Pose2::position).collect();
        points.dedup_by(|a, b| (*a - *b).norm() < SAME_PLACE);
        Ok(Moves { poses, way: Way::new(raw, points) })
    }

    fn along(
        &self,
        course: &Course<'_>,
        moves: &Moves,
        start: Pose2,
        goal: Pose2,
        moving: Option<f64>,
    ) -> Option<Vec<Phase>> {
        let points = &moves.way.points;
        (points.len() > 1).then(|| self.route(course, points, start, goal, moving)).flatten()
    }

    /// From rest: a curve, or else the moves themselves.
    fn phases(&self, course: &Course<'_>, moves: &Moves, start: Pose2, goal: Pose2) -> Option<Vec<Phase>> {
        self.along(course, moves, start, goal, None).or_else(|| straight(course, &moves.poses))
    }

    /// On along the present arc until the robot stands, where the sweep is free, then a plan from there.
    fn brake_outline(
        &self,
        maneuver: &mut Maneuver,
        course: &Course<'_>,
        start: Pose2,
        twist: Twist2,
        goal: Pose2,
    ) -> Option<Plan> {
        let brake = self.brake(start, twist);
        let standing = brake.pose(brake.span());
        if !is_drivable(course, &brake) || !self.fits(standing) {
            return None;
        }
        let mut moves = self.moves(maneuver, course, standing, goal).ok()?;
        let mut phases = vec![Phase::Drive(brake)];
        phases.extend(self.phases(course, &moves, standing, goal)?);
        moves.way.raw.insert(0, start.position());
        moves.way.points.insert(0, start.position());
        Some(self.timed(moves.way, phases, start, twist.v, true))
    }
}

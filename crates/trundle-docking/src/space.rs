use crate::cloud::{DriveQuestion, FEW, HeadingsQuestion, TurnQuestion, join};
use crate::manoeuvre::Motion;
use crate::pace::{Meter, Rest};
use crate::scene::{Blocker, Scene};
use std::f64::consts::TAU;
use std::sync::Arc as Shared;
use trundle_collision::{HeadingArc, HullProfile, RoundedHull, Segment, StraightContact};
use trundle_core::{Footprint, Pose2, Vector2};

/// Motions stop this much before a contact, m or rad, so that the next one begins where nothing touches.
pub const BACK_OFF: f64 = 1e-5;
/// What sums of headings and ways may be off by; far less than what motions back off by.
const ROUNDING: f64 = 1e-9;

/// How far a robot may turn on the spot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeTurn {
    /// Counter-clockwise until the first contact, rad; infinite when nothing is ever met.
    pub left: f64,
    /// Clockwise until the first contact, rad.
    pub right: f64,
    /// What stops it counter-clockwise.
    pub left_by: Option<Blocker>,
    /// What stops it clockwise.
    pub right_by: Option<Blocker>,
}

impl FreeTurn {
    const ALL_ROUND: Self = Self { left: f64::INFINITY, right: f64::INFINITY, left_by: None, right_by: None };

    /// Less, where a piece stands in the way of a hull at a pose. The last two are scratch space.
    pub(crate) fn meet(
        &mut self,
        hull: &RoundedHull,
        segment: &Segment,
        number: u32,
        pose: &Pose2,
        angles: &mut Vec<f64>,
        arcs: &mut Vec<HeadingArc>,
    ) {
        arcs.clear();
        let center = pose.position();
        hull.blocked_headings(&segment.in_frame(center, 1.0, 0.0), angles, arcs);
        for arc in arcs.iter() {
            let (left, right) = arc.free_turn_from(pose.theta);
            let blocker = || Some(Blocker::listed(number, segment.nearest(center)));
            if left < self.left {
                (self.left, self.left_by) = (left, blocker());
            }
            if right < self.right {
                (self.right, self.right_by) = (right, blocker());
            }
        }
    }

    /// Whether a turn by `angle` (rad, counter-clockwise positive) is free.
    pub fn allows(&self, angle: f64) -> bool {
        angle <= self.left + ROUNDING && -angle <= self.right + ROUNDING
    }

    /// The turn that takes the heading by `angle` (in (-pi, pi], rad): the shorter way where it is free, or the longer.
    pub fn way(&self, angle: f64) -> Option<f64> {
        let longer = -(TAU - angle.abs()).copysign(angle);
        [angle, longer].into_iter().find(|&turn| self.allows(turn))
    }
}

/// How far a robot may drive straight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeDrive {
    /// Forward until the first contact, m, at most what was asked for.
    pub ahead: f64,
    /// Backward until the first contact, m.
    pub behind: f64,
    /// What stops it ahead.
    pub ahead_by: Option<Blocker>,
    /// What stops it behind.
    pub behind_by: Option<Blocker>,
}

impl FreeDrive {
    /// Less, where a piece seen from a hull stands in its way; `blocker` says which piece it is, and where.
    pub(crate) fn meet(&mut self, hull: &RoundedHull, seen: &Segment, blocker: impl Fn() -> (u32, Vector2)) {
        let by = || {
            let (number, at) = blocker();
            Some(Blocker::listed(number, at))
        };
        match hull.straight_contact(seen) {
            Some(StraightContact::Ahead(way)) if way < self.ahead => {
                (self.ahead, self.ahead_by) = (way, by())
            }
            Some(StraightContact::Behind(way)) if way < self.behind => {
                (self.behind, self.behind_by) = (way, by())
            }
            _ => {}
        }
    }

    /// Whether a straight move of `way` (m, backward negative) is free.
    pub fn allows(&self, way: f64) -> bool {
        way <= self.ahead + ROUNDING && -way <= self.behind + ROUNDING
    }
}

/// A hull among obstacles: every question about contact, answered in closed form.
#[derive(Debug, Clone)]
pub struct Space<'a> {
    scene: &'a Scene,
    hull: RoundedHull,
    /// Where there are many points.
    profile: Option<HullProfile>,
    angles: Vec<f64>,
    arcs: Vec<HeadingArc>,
    meter: Shared<Meter>,
    /// Among many points: blocked headings that may be left out, rad.
    little: f64,
}

/// Three millimetres at the end of an arm of 0.3 m, rad.
const LITTLE: f64 = 0.01;
/// What a piece costs when it is asked for headings and when it is asked for ways, in units of [`Space::work`].
const HEADINGS_COST: u64 = 40;
const WAY_COST: u64 = 5;

impl<'a> Space<'a> {
    /// A footprint grown by `margin` (m, at least 0.1 mm) among obstacles.
    pub fn new(footprint: &Footprint, margin: f64, scene: &'a Scene) -> Self {
        Self::metered(RoundedHull::new(footprint, margin), scene, Meter::endless(u64::MAX))
    }

    /// A hull among obstacles, the work counted by `meter`.
    pub(crate) fn metered(hull: RoundedHull, scene: &'a Scene, meter: Shared<Meter>) -> Self {
        let points = scene.points().len();
        let profile = (points > FEW).then(|| HullProfile::new(&hull, points));
        meter.spend(profile.as_ref().map_or(0, HullProfile::cost));
        Self { scene, hull, profile, angles: Vec::new(), arcs: Vec::new(), meter, little: LITTLE }
    }

    /// The same obstacles for another hull; their work is counted together.
    pub(crate) fn with_hull(&self, hull: RoundedHull) -> Self {
        Self::metered(hull, self.scene, Shared::clone(&self.meter))
    }

    /// From now on headings are told no finer than what is `length` (m) at the farthest point.
    pub(crate) fn tell_headings_within(&mut self, length: f64) {
        self.little = length / self.hull.outer_radius();
    }

    /// The footprint with its margin.
    pub fn hull(&self) -> &RoundedHull {
        &self.hull
    }

    /// What stands around.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// What its answers have cost so far, those of its clones included: counted steps, each about ten nanoseconds on a
    /// processor of 2020. The same on every machine.
    pub fn work(&self) -> u64 {
        self.meter.work()
    }

    /// What the whole plan may come to.
    pub(crate) fn most(&self) -> u64 {
        self.meter.most
    }

    /// [`Space::work`] after so much more, at most what the whole plan may come to.
    pub(crate) fn until(&self, more: u64) -> u64 {
        self.work().saturating_add(more).min(self.meter.most)
    }

    /// Whether the whole plan has come to that.
    pub(crate) fn is_spent(&self) -> bool {
        self.meter.is_spent()
    }

    /// Counts work done elsewhere on behalf of this space.
    pub(crate) fn spend(&self, work: u64) {
        self.meter.spend(work);
    }

    /// Waits, where the work is done in parts, until more may be done.
    pub(crate) fn rest(&self) -> Rest<'_> {
        Rest(&self.meter)
    }

    /// What the hull overlaps at a pose, if anything.
    pub fn contact(&self, pose: &Pose2) -> Option<Blocker> {
        let (nearest, work) = self.scene.nearest(&self.hull, pose, 1e-12);
        self.spend(work);
        nearest.map(|(_, blocker)| blocker)
    }

    /// What stops a motion from `pose` before its end, if anything.
    pub fn in_the_way(&mut self, pose: &Pose2, motion: Motion) -> Option<Blocker> {
        match motion {
            Motion::Turn(angle) => {
                let free = self.turn(pose);
                let by = if angle > 0.0 { free.left_by } else { free.right_by };
                by.filter(|_| !free.allows(angle))
            }
            Motion::Drive(way) => {
                let free = self.drive(pose, way.abs() + 0.01);
                let by = if way > 0.0 { free.ahead_by } else { free.behind_by };
                by.filter(|_| !free.allows(way))
            }
        }
    }

    /// How far the base may turn on the spot each way.
    pub fn turn(&mut self, pose: &Pose2) -> FreeTurn {
        let mut free = FreeTurn::ALL_ROUND;
        let (hull, angles, arcs) = (&self.hull, &mut self.angles, &mut self.arcs);
        let (center, half) = (pose.position(), Vector2::repeat(hull.outer_radius()));
        let mut work = self.scene.pieces().len() as u64;
        self.scene.visit_pieces(center, half, |segment, number| {
            free.meet(hull, segment, number, pose, angles, arcs);
            work += HEADINGS_COST;
        });
        match &self.profile {
            Some(profile) => {
                let mut question = TurnQuestion::new((hull, profile), pose, (angles, arcs), &mut free);
                work += self.scene.ask(&mut question);
            }
            None => self.scene.visit_points(center, half, |p, number| {
                free.meet(hull, &Segment::point(p), number, pose, angles, arcs);
                work += HEADINGS_COST;
            }),
        }
        self.spend(work);
        free.left = (free.left - BACK_OFF).max(0.0);
        free.right = (free.right - BACK_OFF).max(0.0);
        free
    }

    /// How far the base may drive straight each way, looking `reach` (m) far.
    pub fn drive(&self, pose: &Pose2, reach: f64) -> FreeDrive {
        let mut free = FreeDrive { ahead: reach, behind: reach, ahead_by: None, behind_by: None };
        let (direction, outer) = (pose.direction(), self.hull.outer_radius());
        let center = pose.position();
        let half = Vector2::new(direction.x.abs(), direction.y.abs()) * reach + Vector2::repeat(outer);
        let hull = &self.hull;
        let mut work = self.scene.pieces().len() as u64;
        let mut look = |segment: &Segment, number: u32| {
            work += WAY_COST;
            let seen = segment.in_frame(center, direction.x, direction.y);
            if seen.a.y.min(seen.b.y) <= outer && seen.a.y.max(seen.b.y) >= -outer {
                free.meet(hull, &seen, || (number, segment.nearest(center)));
            }
        };
        self.scene.visit_pieces(center, half, &mut look);
        match &self.profile {
            Some(profile) => work += self.scene.ask(&mut DriveQuestion::new(hull, profile, pose, &mut free)),
            None => self.scene.visit_points(center, half, |p, number| look(&Segment::point(p), number)),
        }
        self.spend(work);
        free.ahead = (free.ahead - BACK_OFF).max(0.0);
        free.behind = (free.behind - BACK_OFF).max(0.0);
        free
    }

    /// Adds the headings at which a base at `position` overlaps something, sorted and joined; among many points some
    /// hundredths of a radian of them may be left out.
    pub fn blocked_headings(&mut self, position: Vector2, blocked: &mut Vec<HeadingArc>) {
        let (hull, angles) = (&self.hull, &mut self.angles);
        let (first, half) = (blocked.len(), Vector2::repeat(hull.outer_radius()));
        let mut work = self.scene.pieces().len() as u64;
        self.scene.visit_pieces(position, half, |segment, _| {
            hull.blocked_headings(&segment.in_frame(position, 1.0, 0.0), angles, blocked);
            work += HEADINGS_COST;
        });
        match &self.profile {
            Some(profile) => {
                join(blocked, first);
                let all = (hull, profile);
                let mut question =
                    HeadingsQuestion::new(all, position, angles, blocked, (first, self.little));
                work += self.scene.ask(&mut question);
            }
            None => self.scene.visit_points(position, half, |p, _| {
                let segment = Segment::point(p).in_frame(position, 1.0, 0.0);
                hull.blocked_headings(&segment, angles, blocked);
                work += HEADINGS_COST;
            }),
        }
        self.spend(work);
        join(blocked, first);
    }
}

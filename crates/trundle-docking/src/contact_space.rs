//! A hull among obstacles: contacts, free turns, free straight moves and blocked headings.

use crate::free_motion::{BACK_OFF, FreeDrive, FreeTurn};
use crate::motion::manoeuvre::Motion;
use crate::point_queries::headings::{HeadingsQuery, join};
use crate::point_queries::limits::FEW_POINTS;
use crate::point_queries::straight::StraightQuery;
use crate::point_queries::turn::TurnQuery;
use crate::scene::blocker::Blocker;
use crate::scene::obstacle_scene::ObstacleScene;
use crate::work_budget::{BudgetYield, WorkBudget};
use std::sync::Arc as Shared;
use trundle_collision::{HeadingArc, HullProfile, RoundedHull, Segment, blocked_headings};
use trundle_core::{Footprint, Pose2, Vector2};

/// A hull among obstacles: contact queries in closed form.
#[derive(Debug, Clone)]
pub struct ContactSpace<'a> {
    scene: &'a ObstacleScene,
    hull: RoundedHull,
    /// Lookup table of the hull, for many points.
    profile: Option<HullProfile>,
    angles: Vec<f64>,
    arcs: Vec<HeadingArc>,
    budget: Shared<WorkBudget>,
    /// Among many points: width of blocked headings that may be missing, rad.
    missing_heading: f64,
}

/// Default width of blocked headings that may be missing, rad: 3 mm at the end of an arm of 0.3 m. Source: ours.
const MISSING_HEADING_RAD: f64 = 0.01;
/// Counted cost of the blocked headings of a segment, in units of [`ContactSpace::work`]. Source: ours.
const HEADINGS_COST: u64 = 40;
/// Counted cost of the free distance to a segment, in units of [`ContactSpace::work`]. Source: ours.
const STRAIGHT_COST: u64 = 5;

impl<'a> ContactSpace<'a> {
    /// A footprint with a `margin` (m) among obstacles; without one it may touch them.
    pub fn new(footprint: &Footprint, margin: f64, scene: &'a ObstacleScene) -> Self {
        Self::metered(RoundedHull::new(footprint, margin), scene, WorkBudget::endless(u64::MAX))
    }

    /// A hull among obstacles; `budget` counts the work.
    pub(crate) fn metered(hull: RoundedHull, scene: &'a ObstacleScene, budget: Shared<WorkBudget>) -> Self {
        let points = scene.points().len();
        let profile = (points > FEW_POINTS).then(|| HullProfile::new(&hull, points));
        budget.spend(profile.as_ref().map_or(0, HullProfile::cost));
        Self {
            scene,
            hull,
            profile,
            angles: Vec::new(),
            arcs: Vec::new(),
            budget,
            missing_heading: MISSING_HEADING_RAD,
        }
    }

    /// The same obstacles for another hull; their work is counted together.
    pub(crate) fn with_hull(&self, hull: RoundedHull) -> Self {
        Self::metered(hull, self.scene, Shared::clone(&self.budget))
    }

    /// Sets the resolution of blocked headings to `length` (m) at the farthest point of the hull.
    pub(crate) fn set_heading_resolution(&mut self, length: f64) {
        self.missing_heading = length / self.hull.outer_radius();
    }

    /// The footprint with its margin.
    pub fn hull(&self) -> &RoundedHull {
        &self.hull
    }

    /// The obstacles.
    pub fn scene(&self) -> &'a ObstacleScene {
        self.scene
    }

    /// Counted cost of all queries, including those of clones: steps of about ten nanoseconds on a processor of 2020. The count is equal on
    /// every machine.
    pub fn work(&self) -> u64 {
        self.budget.work()
    }

    /// Cost limit of the whole plan.
    pub(crate) fn max(&self) -> u64 {
        self.budget.max
    }

    /// [`ContactSpace::work`] after `more` work, at most the limit of the whole plan.
    pub(crate) fn until(&self, more: u64) -> u64 {
        self.work().saturating_add(more).min(self.budget.max)
    }

    /// Whether the work of the whole plan has reached its limit.
    pub(crate) fn is_spent(&self) -> bool {
        self.budget.is_spent()
    }

    /// Adds work done elsewhere for this space.
    pub(crate) fn spend(&self, work: u64) {
        self.budget.spend(work);
    }

    /// Yields, if the work is done in parts, until more work is granted.
    pub(crate) fn yield_point(&self) -> BudgetYield<'_> {
        BudgetYield(&self.budget)
    }

    /// The obstacle that the hull overlaps at a pose, if any.
    pub fn contact(&self, pose: &Pose2) -> Option<Blocker> {
        let (nearest, work) = self.scene.nearest(&self.hull, pose, 1e-12);
        self.spend(work);
        nearest.map(|(_, blocker)| blocker)
    }

    /// The obstacle that stops a motion from `pose` before its end; `None` if the motion is free.
    pub fn blocker_of(&mut self, pose: &Pose2, motion: Motion) -> Option<Blocker> {
        match motion {
            Motion::Turn(angle) => {
                let free = self.turn(pose);
                let by = if angle > 0.0 { free.left_by } else { free.right_by };
                by.filter(|_| !free.allows(angle))
            }
            Motion::Drive(distance) => {
                let free = self.drive(pose, distance.abs() + 0.01);
                let by = if distance > 0.0 { free.ahead_by } else { free.behind_by };
                by.filter(|_| !free.allows(distance))
            }
        }
    }

    /// The free turn in place at a pose.
    pub fn turn(&mut self, pose: &Pose2) -> FreeTurn {
        let mut free = FreeTurn::ALL_ROUND;
        let (hull, angles, arcs) = (&self.hull, &mut self.angles, &mut self.arcs);
        let (center, half) = (pose.position(), Vector2::repeat(hull.outer_radius()));
        let mut work = self.scene.pieces().len() as u64;
        self.scene.visit_pieces(center, half, |segment, number| {
            free.limit_by(hull, segment, number, pose, angles, arcs);
            work += HEADINGS_COST;
        });
        match &self.profile {
            Some(profile) => {
                let mut query = TurnQuery::new((hull, profile), pose, (angles, arcs), &mut free);
                work += self.scene.run_query(&mut query);
            }
            None => self.scene.visit_points(center, half, |p, number| {
                free.limit_by(hull, &Segment::point(p), number, pose, angles, arcs);
                work += HEADINGS_COST;
            }),
        }
        self.spend(work);
        free.left = (free.left - BACK_OFF).max(0.0);
        free.right = (free.right - BACK_OFF).max(0.0);
        free
    }

    /// The free straight moves at a pose, up to `reach` (m).
    pub fn drive(&self, pose: &Pose2, reach: f64) -> FreeDrive {
        let mut free = FreeDrive { ahead: reach, behind: reach, ahead_by: None, behind_by: None };
        let (direction, outer) = (pose.direction(), self.hull.outer_radius());
        let center = pose.position();
        let half = Vector2::new(direction.x.abs(), direction.y.abs()) * reach + Vector2::repeat(outer);
        let hull = &self.hull;
        let mut work = self.scene.pieces().len() as u64;
        let mut limit = |segment: &Segment, number: u32| {
            work += STRAIGHT_COST;
            let seen = segment.in_frame(center, direction.x, direction.y);
            if seen.a.y.min(seen.b.y) <= outer && seen.a.y.max(seen.b.y) >= -outer {
                free.limit_by(hull, &seen, || (number, segment.nearest(center)));
            }
        };
        self.scene.visit_pieces(center, half, &mut limit);
        match &self.profile {
            Some(profile) => {
                work += self.scene.run_query(&mut StraightQuery::new(hull, profile, pose, &mut free))
            }
            None => self.scene.visit_points(center, half, |p, number| limit(&Segment::point(p), number)),
        }
        self.spend(work);
        free.ahead = (free.ahead - BACK_OFF).max(0.0);
        free.behind = (free.behind - BACK_OFF).max(0.0);
        free
    }

    /// Adds the headings at which a base at `position` overlaps an obstacle, sorted and joined. Among many points, up to some hundredths of
    /// a radian may be missing.
    pub fn blocked_headings(&mut self, position: Vector2, blocked: &mut Vec<HeadingArc>) {
        let (hull, angles) = (&self.hull, &mut self.angles);
        let (first, half) = (blocked.len(), Vector2::repeat(hull.outer_radius()));
        let mut work = self.scene.pieces().len() as u64;
        self.scene.visit_pieces(position, half, |segment, _| {
            blocked_headings(hull, &segment.in_frame(position, 1.0, 0.0), angles, blocked);
            work += HEADINGS_COST;
        });
        match &self.profile {
            Some(profile) => {
                join(blocked, first);
                let all = (hull, profile);
                let mut query =
                    HeadingsQuery::new(all, position, angles, blocked, (first, self.missing_heading));
                work += self.scene.run_query(&mut query);
            }
            None => self.scene.visit_points(position, half, |p, _| {
                let segment = Segment::point(p).in_frame(position, 1.0, 0.0);
                blocked_headings(hull, &segment, angles, blocked);
                work += HEADINGS_COST;
            }),
        }
        self.spend(work);
        join(blocked, first);
    }
}

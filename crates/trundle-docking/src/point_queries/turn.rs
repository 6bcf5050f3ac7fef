//! Query of point clouds: free turn in place.

use crate::free_motion::FreeTurn;
use crate::point_queries::limits::SAME_CONTACT;
use crate::scene::point_index::PointQuery;
use trundle_collision::{HeadingArc, HullProfile, OrientedBox, RoundedHull, Segment};
use trundle_core::{Pose2, Vector2};

/// The free turn in place of a hull.
pub struct TurnQuery<'q> {
    hull: &'q RoundedHull,
    profile: &'q HullProfile,
    pose: Pose2,
    direction: Vector2,
    angles: &'q mut Vec<f64>,
    arcs: &'q mut Vec<HeadingArc>,
    free: &'q mut FreeTurn,
}

impl<'q> TurnQuery<'q> {
    /// A query that continues from the turn in `free`; the other two are buffers.
    pub fn new(
        (hull, profile): (&'q RoundedHull, &'q HullProfile),
        pose: &Pose2,
        (angles, arcs): (&'q mut Vec<f64>, &'q mut Vec<HeadingArc>),
        free: &'q mut FreeTurn,
    ) -> Self {
        Self { hull, profile, pose: *pose, direction: pose.direction(), angles, arcs, free }
    }
}

impl PointQuery for TurnQuery<'_> {
    const COST: u64 = 50;

    fn relevance(&self, patch: &OrientedBox) -> Option<f64> {
        let seen = patch.in_frame(self.pose.position(), self.direction);
        let (left, right) = self.profile.free_turns(&seen)?;
        (left + SAME_CONTACT < self.free.left || right + SAME_CONTACT < self.free.right)
            .then(|| left.min(right))
    }

    fn visit(&mut self, p: Vector2, number: u32) {
        let segment = Segment::point(p);
        self.free.limit_by(self.hull, &segment, number, &self.pose, self.angles, self.arcs);
    }
}

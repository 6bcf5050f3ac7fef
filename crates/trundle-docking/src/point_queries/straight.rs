//! Query of point clouds: free distance of a straight move.

use crate::free_motion::FreeDrive;
use crate::point_queries::limits::SAME_CONTACT;
use crate::scene::point_index::PointQuery;
use trundle_collision::{HullProfile, OrientedBox, RoundedHull, Segment};
use trundle_core::{Pose2, Vector2};

/// The free distance of a straight move of a hull.
pub struct StraightQuery<'q> {
    hull: &'q RoundedHull,
    profile: &'q HullProfile,
    center: Vector2,
    direction: Vector2,
    free: &'q mut FreeDrive,
}

impl<'q> StraightQuery<'q> {
    /// A query that continues from the distances in `free`.
    pub fn new(
        hull: &'q RoundedHull,
        profile: &'q HullProfile,
        pose: &Pose2,
        free: &'q mut FreeDrive,
    ) -> Self {
        Self { hull, profile, center: pose.position(), direction: pose.direction(), free }
    }

    fn seen(&self, p: Vector2) -> Segment {
        Segment::point(p).in_frame(self.center, self.direction.x, self.direction.y)
    }
}

impl PointQuery for StraightQuery<'_> {
    const COST: u64 = 5;

    fn relevance(&self, patch: &OrientedBox) -> Option<f64> {
        let seen = patch.in_frame(self.center, self.direction);
        let (ahead, behind) = self.profile.free_distances(&seen);
        (ahead + SAME_CONTACT < self.free.ahead || behind + SAME_CONTACT < self.free.behind)
            .then(|| ahead.min(behind))
    }

    fn visit(&mut self, p: Vector2, number: u32) {
        self.free.limit_by(self.hull, &self.seen(p), || (number, p));
    }
}

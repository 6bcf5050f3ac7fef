use super::SAME;
use crate::scene::Question;
use crate::space::FreeDrive;
use trundle_collision::{HullProfile, OrientedBox, RoundedHull, Segment};
use trundle_core::{Pose2, Vector2};

/// How far a hull may drive straight.
pub struct DriveQuestion<'q> {
    hull: &'q RoundedHull,
    profile: &'q HullProfile,
    center: Vector2,
    direction: Vector2,
    free: &'q mut FreeDrive,
}

impl<'q> DriveQuestion<'q> {
    /// What is known so far is in `free`.
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

impl Question for DriveQuestion<'_> {
    const COST: u64 = 5;

    fn promise(&self, patch: &OrientedBox) -> Option<f64> {
        let seen = patch.in_frame(self.center, self.direction);
        let (ahead, behind) = self.profile.free_distances(&seen);
        (ahead + SAME < self.free.ahead || behind + SAME < self.free.behind).then(|| ahead.min(behind))
    }

    fn look(&mut self, p: Vector2, number: u32) {
        self.free.meet(self.hull, &self.seen(p), || (number, p));
    }
}

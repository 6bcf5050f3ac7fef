use super::SAME;
use crate::scene::Question;
use crate::space::FreeTurn;
use trundle_collision::{HeadingArc, HullProfile, OrientedBox, RoundedHull, Segment};
use trundle_core::{Pose2, Vector2};

/// How far a hull may turn on the spot.
pub struct TurnQuestion<'q> {
    hull: &'q RoundedHull,
    profile: &'q HullProfile,
    pose: Pose2,
    direction: Vector2,
    angles: &'q mut Vec<f64>,
    arcs: &'q mut Vec<HeadingArc>,
    free: &'q mut FreeTurn,
}

impl<'q> TurnQuestion<'q> {
    /// What is known so far is in `free`; the other two are scratch space.
    pub fn new(
        (hull, profile): (&'q RoundedHull, &'q HullProfile),
        pose: &Pose2,
        (angles, arcs): (&'q mut Vec<f64>, &'q mut Vec<HeadingArc>),
        free: &'q mut FreeTurn,
    ) -> Self {
        Self { hull, profile, pose: *pose, direction: pose.direction(), angles, arcs, free }
    }
}

impl Question for TurnQuestion<'_> {
    const COST: u64 = 50;

    fn promise(&self, patch: &OrientedBox) -> Option<f64> {
        let seen = patch.in_frame(self.pose.position(), self.direction);
        let (left, right) = self.profile.free_turns(&seen)?;
        (left + SAME < self.free.left || right + SAME < self.free.right).then(|| left.min(right))
    }

    fn look(&mut self, p: Vector2, number: u32) {
        let segment = Segment::point(p);
        self.free.meet(self.hull, &segment, number, &self.pose, self.angles, self.arcs);
    }
}

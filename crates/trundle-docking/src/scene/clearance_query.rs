//! Query of point clouds: clearance of a hull at rest.

use crate::scene::blocker::Blocker;
use crate::scene::point_index::PointQuery;
use trundle_collision::{OrientedBox, RoundedHull, Segment};
use trundle_core::{Pose2, Vector2};

/// The obstacle nearest to a hull at rest, and its distance (m).
pub struct ClearanceQuery<'q> {
    hull: &'q RoundedHull,
    at: Vector2,
    direction: (f64, f64),
    /// Largest distance of interest, m.
    reach: f64,
    best: &'q mut Option<(f64, Blocker)>,
}

impl<'q> ClearanceQuery<'q> {
    /// A query that continues from the obstacle in `best`.
    pub fn new(
        hull: &'q RoundedHull,
        pose: &Pose2,
        reach: f64,
        best: &'q mut Option<(f64, Blocker)>,
    ) -> Self {
        let (sin, cos) = pose.theta.sin_cos();
        Self { hull, at: pose.position(), direction: (cos, sin), reach, best }
    }

    fn distance(&self, piece: &Segment) -> f64 {
        let (cos, sin) = self.direction;
        self.hull.distance(&piece.in_frame(self.at, cos, sin))
    }
}

impl PointQuery for ClearanceQuery<'_> {
    fn relevance(&self, patch: &OrientedBox) -> Option<f64> {
        let away = patch.in_frame(self.at, Vector2::x()).distance_from_origin() - self.hull.outer_radius();
        let known = self.best.map_or(self.reach, |(min, _)| min);
        if away >= known || known <= 0.0 {
            return None;
        }
        let min = self.distance(&patch.centre_line()) - patch.half.y;
        (min < known).then_some(min)
    }

    fn visit(&mut self, p: Vector2, number: u32) {
        let distance = self.distance(&Segment::point(p));
        if distance < self.best.map_or(self.reach, |(min, _)| min) {
            *self.best = Some((distance, Blocker::listed(number, p)));
        }
    }
}

//! Footprints and segments of the tests.

use proptest::prelude::*;
use trundle_collision::{RoundedHull, Segment};
use trundle_core::{Footprint, Pose2, Vector2};

/// Corners of a robot of five sides, the axle off its centre.
pub fn corners() -> Vec<Vector2> {
    [(0.4, 0.0), (0.3, 0.2), (-0.25, 0.22), (-0.3, -0.2), (0.3, -0.2)]
        .map(|(x, y)| Vector2::new(x, y))
        .to_vec()
}

pub fn polygon() -> Footprint {
    Footprint::polygon(corners()).unwrap()
}

pub fn hull(margin: f64) -> RoundedHull {
    RoundedHull::new(&polygon(), margin)
}

pub fn any_point() -> impl Strategy<Value = Vector2> {
    (-1.2..1.2_f64, -1.2..1.2_f64).prop_map(|(x, y)| Vector2::new(x, y))
}

pub fn any_segment() -> impl Strategy<Value = Segment> {
    (any_point(), any_point()).prop_map(|(a, b)| Segment { a, b })
}

pub fn any_pose() -> impl Strategy<Value = Pose2> {
    (-2.0..2.0_f64, -2.0..2.0_f64, -3.1..3.1_f64).prop_map(|(x, y, theta)| Pose2::new(x, y, theta))
}

/// The segment in the frame of a base at `pose`.
pub fn seen_from(pose: Pose2, segment: &Segment) -> Segment {
    let inverse = pose.inverse();
    Segment { a: inverse.transform(segment.a), b: inverse.transform(segment.b) }
}

//! Extreme and invalid inputs.

use proptest::prelude::*;
use trundle_core::{Beam, Cell, Footprint, GridGeometry, OccupancyGrid, Pose2, Scan, Stamp, Vector2};
use trundle_viz::FeatureMark;

/// Mostly plausible numbers, sometimes arbitrary ones.
pub fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![6 => -8.0..8.0_f64, 1 => any::<f64>(), 1 => Just(f64::NAN), 1 => -1e9..1e9_f64]
}

pub fn any_point() -> impl Strategy<Value = Vector2> {
    (any_number(), any_number()).prop_map(|(x, y)| Vector2::new(x, y))
}

pub fn any_points() -> impl Strategy<Value = Vec<Vector2>> {
    prop::collection::vec(any_point(), 0..30)
}

pub fn any_pose() -> impl Strategy<Value = Pose2> {
    (any_number(), any_number(), any_number()).prop_map(|(x, y, theta)| Pose2 { x, y, theta })
}

pub fn any_footprint() -> impl Strategy<Value = Footprint> {
    let corners = prop::collection::vec(any_point(), 0..6);
    prop_oneof![
        any_number().prop_map(|radius| Footprint::Disc { radius }),
        corners.prop_map(|corners| Footprint::Polygon { corners })
    ]
}

pub fn any_grid() -> impl Strategy<Value = OccupancyGrid> {
    let resolution =
        prop_oneof![8 => 0.02..0.5_f64, 1 => Just(f64::MIN_POSITIVE), 1 => Just(1e300), 1 => Just(5e-324)];
    let origin = prop_oneof![8 => -5.0..5.0_f64, 1 => Just(-1e300), 1 => Just(1e12)];
    (resolution, origin, 1..60_usize, 1..60_usize, any::<u64>(), 0..4_u64).prop_map(
        |(resolution, origin, w, h, bits, mix)| {
            // Beyond this distance, a geometry cannot distinguish its cells.
            let farthest = resolution * 2_f64.powi(39);
            let origin = origin.clamp(-farthest, farthest);
            let geometry =
                GridGeometry::new(resolution, Vector2::new(origin, -origin), w, h).expect("a geometry");
            let cell = |i: u64| match (bits.rotate_left((i % 64) as u32) ^ i) % (mix + 1) {
                0 => Cell::Unknown,
                1 => Cell::Free,
                _ => Cell::Occupied,
            };
            OccupancyGrid::new(geometry, (0..(w * h) as u64).map(cell).collect())
                .expect("as many cells as needed")
        },
    )
}

pub fn any_scan() -> impl Strategy<Value = Scan> {
    let range = prop_oneof![8 => 0.0..8.0_f64, 1 => Just(1e300)];
    let beam = prop_oneof![
        range.clone().prop_map(|range| Beam::Hit { range }),
        range.prop_map(|range| Beam::Free { range }),
        Just(Beam::Unseen)
    ];
    prop::collection::vec(beam, 0..60).prop_map(|beams| {
        Scan::new(Stamp::default(), Vector2::new(0.1, 0.0), -0.7, 0.02, beams).expect("a scan")
    })
}

pub fn any_marks() -> impl Strategy<Value = Vec<FeatureMark>> {
    let mark = (any_number(), any_number(), any_number(), any_number(), any::<bool>());
    prop::collection::vec(mark, 0..20).prop_map(|marks| {
        marks
            .into_iter()
            .map(|(x, y, size, angle, tracked)| FeatureMark { x: 9.0 * x, y, size, angle, tracked })
            .collect()
    })
}

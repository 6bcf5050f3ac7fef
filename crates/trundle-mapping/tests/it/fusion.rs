//! Laws of the fusion of scans.

use proptest::prelude::*;
use trundle_core::{Beam, Pose2, Scan, Stamp, Vector2};
use trundle_mapping::{ScanFusion, ScanFusionConfig};

fn any_scan() -> impl Strategy<Value = Scan> {
    let beam = prop_oneof![
        (0.3..5.0_f64).prop_map(|range| Beam::Hit { range }),
        (0.3..5.0_f64).prop_map(|range| Beam::Free { range }),
        Just(Beam::Unseen),
    ];
    (prop::collection::vec(beam, 1..60), 0..1_000_i64).prop_map(|(beams, nanos)| {
        Scan::new(Stamp::from_nanos(nanos), Vector2::new(0.1, 0.0), -0.7, 0.03, beams).unwrap()
    })
}

fn any_pose() -> impl Strategy<Value = Pose2> {
    (-0.3..0.3_f64, -0.3..0.3_f64, -3.0..3.0_f64).prop_map(|(x, y, theta)| Pose2::new(x, y, theta))
}

fn fused(parts: &[(Pose2, &Scan)]) -> Scan {
    ScanFusion::new(ScanFusionConfig::default()).unwrap().fuse(parts.iter().copied())
}

/// Ranges of hits by beam.
fn hits(scan: &Scan) -> Vec<Option<f64>> {
    let hit = |beam: &Beam| if let Beam::Hit { range } = beam { Some(*range) } else { None };
    scan.beams().iter().map(hit).collect()
}

proptest! {
    #[test]
    fn the_order_of_the_sensors_does_not_matter(
        a in any_scan(), b in any_scan(), at in any_pose(), and in any_pose(),
    ) {
        let (one, other) = (fused(&[(at, &a), (and, &b)]), fused(&[(and, &b), (at, &a)]));
        prop_assert_eq!(one.stamp(), other.stamp());
        prop_assert_eq!(one.all_free_spans().map(<[_]>::len), other.all_free_spans().map(<[_]>::len));
        for (x, y) in hits(&one).into_iter().zip(hits(&other)) {
            prop_assert!(x.is_some() == y.is_some() && (x.unwrap_or(0.0) - y.unwrap_or(0.0)).abs() < 1e-9);
        }
    }

    #[test]
    fn a_sensor_that_sees_nothing_and_one_with_a_broken_pose_add_nothing(a in any_scan(), at in any_pose()) {
        let blind = Scan::new(Stamp::default(), Vector2::zeros(), -0.7, 0.03, vec![Beam::Unseen; 30]).unwrap();
        let alone = fused(&[(at, &a)]);
        prop_assert_eq!(&fused(&[(at, &a), (Pose2::IDENTITY, &blind)]), &alone);
        let broken = Pose2 { x: f64::NAN, ..Pose2::IDENTITY };
        prop_assert_eq!(&fused(&[(broken, &blind), (at, &a)]), &alone);
    }

    /// A further sensor makes no obstacle more distant.
    #[test]
    fn more_sensors_see_nearer_obstacles(a in any_scan(), b in any_scan(), at in any_pose(), and in any_pose()) {
        let surface = ScanFusionConfig::default().surface;
        let (alone, both) = (hits(&fused(&[(at, &a)])), hits(&fused(&[(at, &a), (and, &b)])));
        for (alone, both) in alone.into_iter().zip(both) {
            if let Some(alone) = alone {
                prop_assert!(both.is_some_and(|both| both <= alone + surface + 1e-9));
            }
        }
    }

    /// Every hit of a sensor within range is at or behind the fused hit of its bearing.
    #[test]
    fn no_obstacle_is_lost(a in any_scan(), at in any_pose()) {
        let config = ScanFusionConfig::default();
        let all = fused(&[(at, &a)]);
        for point in a.hits().map(|p| at.transform(p)).filter(|p| p.norm() < config.max_range) {
            let bearing = point.y.atan2(point.x);
            let i = (((bearing + std::f64::consts::PI) / all.angle_increment()) as usize).min(config.beams - 1);
            let found = hits(&all)[i];
            prop_assert!(found.is_some_and(|range| range <= point.norm() + config.surface + 1e-9));
        }
    }
}

#[test]
fn nothing_fused_is_an_unseen_circle() {
    let scan = fused(&[]);
    assert_eq!(scan.beams().len(), ScanFusionConfig::default().beams);
    assert!(scan.beams().iter().all(|beam| *beam == Beam::Unseen));
    assert_eq!(scan.all_free_spans().map(<[_]>::len), Some(0));
}

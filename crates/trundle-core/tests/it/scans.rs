//! Laws of scans.

use proptest::prelude::*;
use trundle_core::{Beam, FreeSpan, ObstacleKind, Scan, ScanParts, Stamp, Vector2};

fn any_beam() -> impl Strategy<Value = Beam> {
    prop_oneof![
        (0.0..20.0_f64).prop_map(|range| Beam::Hit { range }),
        (0.0..20.0_f64).prop_map(|range| Beam::Free { range }),
        Just(Beam::Unseen),
    ]
}

fn any_scan() -> impl Strategy<Value = Scan> {
    let beams = prop::collection::vec(any_beam(), 0..40);
    (-0.5..0.5_f64, -0.5..0.5_f64, -3.0..0.0_f64, 0.001..0.1_f64, beams).prop_map(
        |(x, y, first, step, beams)| {
            Scan::new(Stamp::default(), Vector2::new(x, y), first, step, beams).unwrap()
        },
    )
}

proptest! {
    #[test]
    fn the_hits_are_the_end_points_of_the_hit_beams_in_order(scan in any_scan()) {
        let mut hits = scan.hits();
        for (i, beam) in scan.beams().iter().enumerate() {
            if let Beam::Hit { range } = beam {
                prop_assert_eq!(hits.next(), Some(scan.point(i, *range)));
            }
        }
        prop_assert_eq!(hits.next(), None);
    }

    #[test]
    fn a_point_has_the_range_and_the_bearing_of_its_beam(scan in any_scan(), i in 0_usize..40, range in 0.01..20.0_f64) {
        let seen = scan.point(i, range) - scan.origin();
        prop_assert!((seen.norm() - range).abs() < 1e-9);
        prop_assert!((scan.angle(i) - scan.angle_min() - i as f64 * scan.angle_increment()).abs() < 1e-12);
        let ahead = Vector2::new(scan.angle(i).cos(), scan.angle(i).sin());
        prop_assert!(seen.perp(&ahead).abs() < 1e-9 && seen.dot(&ahead) > 0.0);
    }

    #[test]
    fn without_free_spans_each_seen_beam_is_free_up_to_its_range(scan in any_scan()) {
        prop_assert_eq!(scan.all_free_spans(), None);
        for (i, beam) in scan.beams().iter().enumerate() {
            let expected = match beam {
                Beam::Hit { range } | Beam::Free { range } => vec![(0.0, *range)],
                Beam::Unseen => vec![],
            };
            prop_assert_eq!(scan.free_spans(i).collect::<Vec<_>>(), expected);
        }
    }

    #[test]
    fn only_hits_have_an_obstacle_and_its_default_kind_is_standing(scan in any_scan()) {
        for (i, beam) in scan.beams().iter().enumerate() {
            let expected = matches!(beam, Beam::Hit { .. }).then_some(ObstacleKind::Standing);
            prop_assert_eq!(scan.obstacle(i), expected);
        }
        prop_assert_eq!(scan.obstacle(scan.beams().len()), None);
    }

    #[test]
    fn a_scan_comes_back_from_its_own_parts(scan in any_scan()) {
        let (stamp, origin, angles) = (scan.stamp(), scan.origin(), (scan.angle_min(), scan.angle_increment()));
        let again = Scan::from_parts(stamp, origin, angles, scan.clone().into_parts()).unwrap();
        prop_assert_eq!(again, scan);
    }

    #[test]
    fn the_free_spans_of_all_beams_are_the_free_spans_of_the_scan(counts in prop::collection::vec(0_u32..4, 1..20)) {
        let spans = |(beam, count): (usize, &u32)| {
            let span = move |k: u32| FreeSpan { beam: beam as u32, from: f64::from(k), to: f64::from(k) + 0.5 };
            (0..*count).map(span).collect::<Vec<_>>()
        };
        let all: Vec<FreeSpan> = counts.iter().enumerate().flat_map(spans).collect();
        let parts = ScanParts { beams: vec![Beam::Unseen; counts.len()], free: Some(all.clone()), ..ScanParts::default() };
        let scan = Scan::from_parts(Stamp::default(), Vector2::zeros(), (0.0, 0.1), parts).unwrap();
        let collected: Vec<_> = (0..counts.len()).flat_map(|i| scan.free_spans(i).collect::<Vec<_>>()).collect();
        prop_assert_eq!(collected, all.iter().map(|span| (span.from, span.to)).collect::<Vec<_>>());
        for (i, count) in counts.iter().enumerate() {
            prop_assert_eq!(scan.free_spans(i).count(), *count as usize);
        }
    }
}

#[test]
fn a_scan_without_free_floor_has_no_free_span() {
    let parts =
        ScanParts { beams: vec![Beam::Hit { range: 2.0 }], free: Some(vec![]), ..ScanParts::default() };
    let scan = Scan::from_parts(Stamp::default(), Vector2::zeros(), (0.0, 0.1), parts).unwrap();
    assert_eq!(scan.free_spans(0).count(), 0);
}

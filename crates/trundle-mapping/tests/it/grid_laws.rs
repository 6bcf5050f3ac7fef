//! Laws of the grid mapper, the live map and the scan matcher.

use crate::flat_room::FlatRoom;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};
use trundle_core::{Beam, Cell, Pose2, Scan, Stamp, Vector2, wrap_angle};
use trundle_mapping::{GridMapper, LiveMapper, MapperConfig, ScanMatchConfig, ScanMatcher};

/// A map without a blind range, whose clamps are far away.
fn open() -> MapperConfig {
    let mut config = MapperConfig::default();
    config.blind_range = 0.0;
    config.clamp_low = 50.0;
    config.clamp_high = 50.0;
    config
}

fn room_scan(room: &FlatRoom, pose: Pose2) -> Scan {
    room.scan(pose, TAU, 360, 8.0, |_| 0.0)
}

fn any_pose() -> impl Strategy<Value = Pose2> {
    (-0.9..0.9_f64, 0.1..1.4_f64, -3.0..3.0_f64).prop_map(|(x, y, theta)| Pose2::new(x, y, theta))
}

/// Log-odds of every cell of the room.
fn log_odds(mapper: &GridMapper) -> Vec<f64> {
    let at = |i: usize| Vector2::new(-3.975 + 0.05 * (i % 160) as f64, -2.975 + 0.05 * (i / 160) as f64);
    (0..160 * 120).map(|i| mapper.log_odds_at(at(i))).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Log-odds add up: the order of the scans does not matter away from the clamps.
    #[test]
    fn the_order_of_the_scans_does_not_matter(poses in prop::collection::vec(any_pose(), 2..6)) {
        let room = FlatRoom::furnished();
        let (mut a, mut b) = (GridMapper::new(open()).unwrap(), GridMapper::new(open()).unwrap());
        for pose in &poses {
            a.insert(*pose, &room_scan(&room, *pose));
        }
        for pose in poses.iter().rev() {
            b.insert(*pose, &room_scan(&room, *pose));
        }
        prop_assert!(log_odds(&a).iter().zip(&log_odds(&b)).all(|(a, b)| (a - b).abs() < 1e-5));
    }

    /// A cell changes by at most one hit or one free ray for each scan.
    #[test]
    fn a_scan_changes_a_cell_once(pose in any_pose()) {
        let room = FlatRoom::furnished();
        let mut mapper = GridMapper::new(open()).unwrap();
        let done = mapper.insert(pose, &room_scan(&room, pose));
        let all = log_odds(&mapper);
        let hits = all.iter().filter(|l| (**l - 0.85).abs() < 1e-6).count();
        let free = all.iter().filter(|l| (**l + 0.4).abs() < 1e-6).count();
        prop_assert_eq!((hits, free), (done.hits, done.free));
        prop_assert_eq!(hits + free, all.iter().filter(|l| **l != 0.0).count());
        prop_assert_eq!(done.ignored_beams, 0);
    }

    /// A live map without corrections equals the map of its scans, and a correction to the same poses moves no scan.
    #[test]
    fn a_live_map_without_corrections_is_the_plain_map(poses in prop::collection::vec(any_pose(), 1..6)) {
        let room = FlatRoom::furnished();
        let (mut live, mut plain) =
            (LiveMapper::new(open()).unwrap(), GridMapper::new(open()).unwrap());
        for (i, pose) in poses.iter().enumerate() {
            let beams = room_scan(&room, *pose).beams().to_vec();
            let scan = Scan::new(Stamp::from_nanos(i as i64), Vector2::zeros(), -3.0, 0.017, beams).unwrap();
            prop_assert_eq!(live.insert(*pose, &scan), plain.insert(*pose, &scan));
        }
        prop_assert_eq!(live.grid(), plain.grid());
        prop_assert_eq!(live.correct(|_, pose| pose), 0);
        prop_assert!(!live.is_redrawing());
        let done = live.work(1_000_000);
        prop_assert_eq!((done.cells, done.left), (0, 0));
        prop_assert_eq!(live.grid(), plain.grid());
    }

    /// Corrections that are undone give the old map back.
    #[test]
    fn a_correction_and_its_inverse_restore_the_map(poses in prop::collection::vec(any_pose(), 1..5), theta in 0.01..0.3_f64) {
        let room = FlatRoom::furnished();
        let mut live = LiveMapper::new(open()).unwrap();
        for (i, pose) in poses.iter().enumerate() {
            let beams = room_scan(&room, *pose).beams().to_vec();
            live.insert(*pose, &Scan::new(Stamp::from_nanos(i as i64), Vector2::zeros(), -3.0, 0.017, beams).unwrap());
        }
        // Two corrections: both maps are then redrawn from the log.
        let by = Pose2::new(0.2, -0.1, theta);
        let mut cells = Vec::new();
        for _ in 0..2 {
            live.correct(|_, pose| by * pose);
            live.work(usize::MAX);
            let logged: Vec<Stamp> = live.logged_stamps().collect();
            prop_assert!(!logged.is_empty());
            live.correct(|_, pose| by.inverse() * pose);
            live.work(usize::MAX);
            cells.push(log_odds(live.mapper()));
        }
        let differ = cells[0].iter().zip(&cells[1]).filter(|(a, b)| (**a - **b).abs() > 1e-3).count();
        prop_assert!(differ <= 4, "{differ} cells differ by rounding at their borders");
    }
}

/// The matcher recovers the same offset at headings all around, in the map and in the map turned by a right angle.
#[test]
fn a_known_offset_is_recovered_at_every_heading() {
    let room = FlatRoom::furnished();
    let mut mapper = GridMapper::new(MapperConfig::default()).unwrap();
    for k in 0..30 {
        let t = TAU * f64::from(k) / 30.0;
        let pose = Pose2::new(2.5 * t.cos(), 1.5 * t.sin(), t);
        mapper.insert(pose, &room_scan(&room, pose));
    }
    let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
    for k in 0..36 {
        let truth = Pose2::new(0.2, 0.4, TAU * f64::from(k) / 36.0 - 3.1);
        let guess = truth * Pose2::new(0.08, -0.06, 0.05);
        let found = matcher.refine(&mapper, &room_scan(&room, truth), guess).unwrap();
        let turned = wrap_angle(found.pose.theta - truth.theta).abs();
        assert!(found.pose.distance(&truth) < 0.015 && turned < 0.006, "{truth:?} {found:?}");
        assert!(found.covariance.symmetric_eigen().eigenvalues.min() > 0.0);
    }
}

#[test]
fn a_saved_grid_comes_back_wherever_its_corner_is() {
    let mut first = GridMapper::new(MapperConfig::default()).unwrap();
    let wall = Scan::new(Stamp::default(), Vector2::zeros(), -0.4, 0.02, vec![Beam::Hit { range: 3.0 }; 40]);
    for k in 0..4 {
        for _ in 0..4 {
            first.insert(
                Pose2::new(-7.3 * f64::from(k), 5.1, f64::from(k) * FRAC_PI_2),
                wall.as_ref().unwrap(),
            );
        }
    }
    let again = GridMapper::from_grid(MapperConfig::default(), first.grid()).unwrap();
    assert_eq!(again.grid(), first.grid());
    let known = first.grid().cells().iter().filter(|cell| **cell != Cell::Unknown).count();
    assert!(known > 1_000);
    let mut coarser = MapperConfig::default();
    coarser.resolution = 0.1;
    assert_eq!(GridMapper::from_grid(coarser, first.grid()).unwrap_err().field, "resolution of the map");
    let mut small = MapperConfig::default();
    small.half_extent = 5.0;
    assert_eq!(GridMapper::from_grid(small, first.grid()).unwrap_err().field, "extent of the map");
}

//! Laws of the localization in a fixed map: tracking, covariance, and what makes the pose unknown.

use crate::filter::{config, laser};
use crate::flat_room::FlatRoom;
use crate::lasting::{hall, mapped, round};
use std::f64::consts::{PI, TAU};
use trundle_core::{Beam, Pose2, Scan, Stamp, Vector2};
use trundle_mapping::{Localized, Lost, MapLocalizer, ParticleMapper};

/// A path around the middle of the room of 6 x 4 m.
fn circle() -> Vec<Pose2> {
    let at = |t: f64| Pose2::new(2.5 * t.cos(), 1.5 * t.sin(), t + PI / 2.0);
    (0..50).map(|i| at(f64::from(i) / 25.0 * PI)).collect()
}

/// A localizer in the map of the room, which has the room's own frame.
fn localizer(seed: u64) -> MapLocalizer {
    let mut mapper = trundle_mapping::GridMapper::new(config(10).map).unwrap();
    for (i, pose) in circle().iter().enumerate() {
        mapper.insert(*pose, &laser(&FlatRoom::furnished(), *pose, i));
    }
    MapLocalizer::from_grid(mapper.grid(), config(10), seed).unwrap()
}

/// The results of a drive along the circle; the odometry's frame begins at `odom_from_map`.
fn drive(mut localizer: MapLocalizer, odom_from_map: Pose2) -> Vec<Localized> {
    let room = FlatRoom::furnished();
    localizer.start_at(circle()[0]);
    let step =
        |(i, pose): (usize, &Pose2)| localizer.update(odom_from_map * *pose, &laser(&room, *pose, 900 + i));
    circle().iter().enumerate().map(step).collect()
}

fn pose_of(result: &Localized) -> Option<Pose2> {
    match result {
        Localized::Known { map_from_base, .. } => Some(*map_from_base),
        _ => None,
    }
}

#[test]
fn the_pose_is_tracked_within_a_cell_and_its_covariance_is_one() {
    let results = drive(localizer(1), Pose2::IDENTITY);
    let mut known = 0;
    for (truth, result) in circle().iter().zip(&results) {
        let Localized::Known { map_from_base, covariance, explained, degenerate } = result else { continue };
        known += 1;
        let off = (map_from_base.inverse() * *truth).log();
        assert!(off.xy().norm() < 0.05 && off.z.abs() < 0.02, "{truth:?}: off by {off:?}");
        assert!((covariance - covariance.transpose()).amax() < 1e-12);
        assert!(covariance.symmetric_eigen().eigenvalues.min() > 0.0, "{covariance}");
        assert!(*explained > 0.7 && *explained <= 1.0 && *degenerate == 0, "{result:?}");
    }
    assert!(known >= 30, "{known} of {} scans", results.len());
}

#[test]
fn the_frame_of_the_odometry_does_not_matter() {
    let here = drive(localizer(1), Pose2::IDENTITY);
    let there = drive(localizer(1), Pose2::new(-40.0, 17.0, 2.5));
    for (a, b) in here.iter().zip(&there) {
        match (pose_of(a), pose_of(b)) {
            (Some(a), Some(b)) => {
                assert!(a.distance(&b) < 0.01 && (a.inverse() * b).theta.abs() < 0.005, "{a:?} {b:?}")
            }
            _ => assert_eq!(a, b),
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_seed_other_ones() {
    assert_eq!(drive(localizer(1), Pose2::IDENTITY), drive(localizer(1), Pose2::IDENTITY));
    assert_ne!(drive(localizer(1), Pose2::IDENTITY), drive(localizer(2), Pose2::IDENTITY));
}

/// A robot that was carried away without notice into a small room: its scans hit where the map is free.
#[test]
fn scans_that_do_not_fit_end_the_tracking() {
    let (room, poses) = (hall(), round());
    let closet = FlatRoom::new(&[&[(-0.6, -0.7), (0.6, -0.7), (0.6, 0.7), (-0.6, 0.7)]]);
    let mut localizer = MapLocalizer::of(&mapped(&room, &poses), 5);
    let at = |k: usize| Pose2::new(0.5, -4.0, 0.5 * k as f64);
    localizer.start_at(poses[0].inverse() * at(0));
    for k in 0..4 {
        let found = pose_of(&localizer.update(at(k), &laser(&room, at(k), 7_000 + k)));
        assert!(
            found.is_some_and(|found| found.distance(&(poses[0].inverse() * at(k))) < 0.05),
            "{k}: {found:?}"
        );
    }
    let turned = |k: usize| Pose2::new(0.05, 0.1, 0.5 * k as f64);
    let inside: Vec<_> =
        (4..14).map(|k| localizer.update(at(k), &laser(&closet, turned(k), 7_000 + k))).collect();
    assert_eq!(inside[4], Localized::Lost(Lost::NothingFits), "the fifth scan: {inside:?}");
    assert!(inside[4..].iter().all(|result| matches!(result, Localized::Lost(_))), "{inside:?}");
}

#[test]
fn along_a_corridor_the_pose_is_as_uncertain_as_the_odometry() {
    let room = FlatRoom::corridor();
    let at = |i: usize| Pose2::new(0.3 * i as f64 - 6.0, 0.1, 0.0);
    let view = |i: usize| room.scan(at(i), TAU, 360, 4.0, |_| 0.0);
    let mut mapper = trundle_mapping::GridMapper::new(config(10).map).unwrap();
    (0..40).for_each(|i| {
        mapper.insert(at(i), &view(i));
    });
    let mut localizer = MapLocalizer::from_grid(mapper.grid(), config(10), 1).unwrap();
    localizer.start_at(at(5));
    let mut along = Vec::new();
    for i in 5..25 {
        if let Localized::Known { covariance, degenerate, map_from_base, .. } =
            localizer.update(at(i), &view(i))
        {
            assert_eq!(degenerate, 1, "scan {i}");
            assert!((map_from_base.y - 0.1).abs() < 0.03, "scan {i}: {map_from_base:?}");
            assert!(covariance[(0, 0)] > 4.0 * covariance[(1, 1)], "scan {i}: {covariance}");
            along.push(covariance[(0, 0)]);
        }
    }
    assert!(along.len() > 10 && along.last() > along.first(), "{along:?}");
}

#[test]
fn a_scan_of_a_robot_that_stands_is_not_used() {
    let room = FlatRoom::furnished();
    let mut localizer = localizer(1);
    localizer.start_at(Pose2::new(0.0, 0.3, 0.0));
    let scan = room.scan(Pose2::new(0.0, 0.3, 0.0), TAU, 360, 8.0, |_| 0.0);
    assert!(matches!(localizer.update(Pose2::IDENTITY, &scan), Localized::Known { .. }));
    assert_eq!(localizer.update(Pose2::new(1e-4, 0.0, 0.0), &scan), Localized::Still);
}

#[test]
fn a_broken_odometry_is_refused_and_the_next_scan_is_used() {
    let room = FlatRoom::furnished();
    let mut localizer = localizer(1);
    localizer.start_at(circle()[0]);
    assert!(pose_of(&localizer.update(circle()[0], &laser(&room, circle()[0], 0))).is_some());
    for wrong in [f64::NAN, f64::INFINITY, 1e7] {
        let result = localizer.update(Pose2 { x: wrong, ..circle()[1] }, &laser(&room, circle()[1], 1));
        assert!(matches!(result, Localized::Refused(_)), "{wrong}: {result:?}");
    }
    let next = pose_of(&localizer.update(circle()[3], &laser(&room, circle()[3], 3))).unwrap();
    assert!(next.distance(&circle()[3]) < 0.05, "{next:?}");
}

#[test]
fn an_empty_map_and_a_blind_scan_give_no_pose() {
    let empty = ParticleMapper::new(config(5), 1).unwrap();
    let scan = FlatRoom::furnished().scan(Pose2::IDENTITY, TAU, 360, 8.0, |_| 0.0);
    let mut nowhere = MapLocalizer::of(&empty, 1);
    assert_eq!(nowhere.update(Pose2::IDENTITY, &scan), Localized::Lost(Lost::NothingToSee));
    let blind = Scan::new(Stamp::default(), Vector2::zeros(), -PI, 0.1, vec![Beam::Unseen; 60]).unwrap();
    assert_eq!(localizer(1).update(Pose2::IDENTITY, &blind), Localized::Lost(Lost::NothingToSee));
}

#[test]
fn a_map_of_other_cells_is_refused_by_field() {
    let grid = localizer(1).grid();
    let mut coarser = config(5);
    coarser.map.resolution = 0.1;
    let error = MapLocalizer::from_grid(&grid, coarser, 1).unwrap_err();
    assert_eq!((error.field.as_str(), error.unit), ("map.resolution", "m"));
    assert!(error.to_string().contains("0.05"), "{error}");
    let mut wrong = config(5);
    wrong.outliers = 2.0;
    assert!(MapLocalizer::from_grid(&grid, wrong, 1).is_err());
}

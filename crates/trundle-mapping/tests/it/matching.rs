//! The scan matcher in a simulated room.

use crate::flat_room::FlatRoom;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_4, TAU};
use trundle_core::{Cell, Invalid, OccupancyGrid, Pose2, wrap_angle};
use trundle_mapping::{GridMapper, LiveMapper, MapperConfig, ScanMatch, ScanMatchConfig, ScanMatcher};

/// The walls of the furnished room, world frame, m.
const WALLS: [(f64, f64); 4] = [(-3.0, -2.0), (3.0, -2.0), (3.0, 2.0), (-3.0, 2.0)];

/// A map drawn from true poses along `poses`, with 1 cm of noise on every range.
fn map_of(room: &FlatRoom, poses: impl Iterator<Item = Pose2>) -> GridMapper {
    let mut mapper = GridMapper::new(MapperConfig::default()).unwrap();
    for (i, pose) in poses.enumerate() {
        mapper.insert(pose, &room.scan(pose, TAU, 720, 8.0, |beam| noise(i * 720 + beam)));
    }
    mapper
}

fn noise(i: usize) -> f64 {
    ((crate::boxes::mix(i as u64) >> 11) as f64 / 2_f64.powi(53) - 0.5) * 0.035
}

fn room_map() -> GridMapper {
    map_of(&FlatRoom::furnished(), circle())
}

/// A path around the furnished room.
fn circle() -> impl Iterator<Item = Pose2> {
    (0..40).map(|i| f64::from(i) / 40.0 * TAU).map(|t| Pose2::new(2.5 * t.cos(), 1.5 * t.sin(), t))
}

fn refine(mapper: &GridMapper, room: &FlatRoom, truth: Pose2, guess: Pose2, view: f64) -> Option<ScanMatch> {
    let beams = (view / TAU * 2000.0) as usize;
    let scan = room.scan(truth, view, beams, 6.0, |beam| noise(beam + 7_000_000));
    ScanMatcher::new(ScanMatchConfig::default()).unwrap().refine(mapper, &scan, guess)
}

#[test]
fn a_wrong_guess_is_pulled_back() {
    let (mapper, room) = (room_map(), FlatRoom::furnished());
    let config = ProptestConfig::with_cases(100);
    let poses = (-1.0..0.8, 0.0..1.4, -3.1..3.1, -0.13..0.13, -0.13..0.13, -0.09..0.09_f64);
    proptest::test_runner::TestRunner::new(config)
        .run(&poses, |(x, y, t, dx, dy, dt)| {
            let truth = Pose2::new(x, y, t);
            let found = refine(&mapper, &room, truth, truth * Pose2::new(dx, dy, dt), TAU).unwrap();
            let turned = wrap_angle(found.pose.theta - t).abs();
            prop_assert!(found.pose.distance(&truth) < 0.015 && turned < 0.006, "{:?} {:?}", found, truth);
            prop_assert!(!found.degenerate && found.score > 0.8);
            let off = (found.pose.inverse() * truth).log();
            let squared = off.dot(&(found.covariance.try_inverse().unwrap() * off));
            prop_assert!(squared < 16.0, "surer than right: {squared}");
            Ok(())
        })
        .unwrap();
}

#[test]
fn a_map_that_was_brought_along_is_matched_with_from_the_first_scan() {
    let room = FlatRoom::furnished();
    // Several positions of the walls relative to the cells.
    for (shift, turn) in [(0.0, 0.0), (0.0125, 0.0), (0.0375, 0.0), (0.0, FRAC_PI_4), (0.01, 0.3)] {
        let map_from_room = Pose2::new(shift, shift, turn);
        let mut drawn = GridMapper::new(MapperConfig::default()).unwrap();
        for (i, pose) in circle().enumerate() {
            drawn.insert(map_from_room * pose, &room.scan(pose, TAU, 720, 8.0, |beam| noise(i * 720 + beam)));
        }
        let mapper = GridMapper::from_grid(MapperConfig::default(), drawn.grid()).unwrap();
        for i in 0..20 {
            let at = |part: usize, size: f64| noise(3 * i + part) / 0.0175 * size;
            let truth = Pose2::new(at(0, 0.9), 0.7 + at(1, 0.7), at(2, 3.1));
            let guess = map_from_room * truth * Pose2::new(at(1, 0.13), at(2, 0.13), at(0, 0.09));
            let scan = room.scan(truth, TAU, 2000, 6.0, |beam| noise(beam + 7_000_000));
            let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
            let found = matcher.refine(&mapper, &scan, guess).unwrap();
            let off = (found.pose.inverse() * map_from_room * truth).log();
            assert!(off.xy().norm() < 0.02 && off.z.abs() < 0.006, "{map_from_room:?} {off:?}");
            let squared = off.dot(&(found.covariance.try_inverse().unwrap() * off));
            assert!(!found.degenerate && squared < 16.0, "surer than right: {squared}");
        }
    }
}

#[test]
fn a_cameras_view_of_a_corner_is_enough() {
    let (mapper, room) = (room_map(), FlatRoom::furnished());
    let truth = Pose2::new(0.5, -0.6, -0.5);
    let found = refine(&mapper, &room, truth, truth * Pose2::new(0.08, -0.06, 0.05), 1.23).unwrap();
    assert!(!found.degenerate);
    assert!(found.pose.distance(&truth) < 0.02 && (found.pose.theta - truth.theta).abs() < 0.01, "{found:?}");
}

#[test]
fn along_a_bare_corridor_nobody_can_tell() {
    let room = FlatRoom::corridor();
    let mapper = map_of(&room, (0..60).map(|i| Pose2::new(f64::from(i) * 0.2 - 6.0, 0.0, 0.0)));
    for heading in [0.0, 0.7, 2.0] {
        let truth = Pose2::new(0.3, 0.1, heading);
        let guess = Pose2::new(0.40, 0.05, heading + 0.05);
        let found = refine(&mapper, &room, truth, guess, TAU).unwrap();
        assert!(found.degenerate);
        assert!(
            (found.pose.y - 0.1).abs() < 0.015 && (found.pose.theta - heading).abs() < 0.006,
            "{found:?}"
        );
        assert!((found.pose.x - 0.40).abs() < 0.03, "it stays where the guess was: {found:?}");
        let along = found.pose.inverse().rotate(trundle_core::Vector2::x());
        let across = found.pose.inverse().rotate(trundle_core::Vector2::y());
        let sigma = |d: trundle_core::Vector2| {
            (d.transpose() * found.covariance.fixed_view::<2, 2>(0, 0) * d)[(0, 0)].sqrt()
        };
        assert!(sigma(along) > 0.5 && sigma(across) < 0.05, "{} {}", sigma(along), sigma(across));
    }
}

#[test]
fn poses_without_overlap_do_not_match() {
    let (mapper, room) = (room_map(), FlatRoom::furnished());
    let here = Pose2::new(0.0, 0.3, 0.4);
    let empty = GridMapper::new(MapperConfig::default()).unwrap();
    assert_eq!(refine(&empty, &room, here, here, TAU), None);
    assert_eq!(refine(&mapper, &room, here, Pose2::new(100.0, 0.0, 0.0), TAU), None);
    assert_eq!(refine(&mapper, &room, here, Pose2 { x: f64::NAN, ..here }, TAU), None);
    assert_eq!(refine(&mapper, &room, here, Pose2::new(0.8, -0.5, 1.2), TAU), None, "far out of the window");
}

#[test]
fn the_same_match_twice_is_the_same_to_the_bit() {
    let (mapper, room) = (room_map(), FlatRoom::furnished());
    let here = Pose2::new(0.0, 0.3, 0.4);
    let once = refine(&mapper, &room, here, Pose2::new(0.05, 0.3, 0.42), 2.0);
    assert!(once.is_some());
    assert_eq!(once, refine(&mapper, &room, here, Pose2::new(0.05, 0.3, 0.42), 2.0));
}

/// Distance of a match from the truth, m, after 60 scans were drawn 0.1 m off over a map of the room.
fn error_after_wrong_drawing(
    begin: impl Fn(MapperConfig, &OccupancyGrid) -> Result<LiveMapper, Invalid>,
) -> f64 {
    let room = FlatRoom::furnished();
    let known = map_of(&room, circle());
    let mut live = begin(MapperConfig::default(), known.grid()).unwrap();
    let truth = Pose2::new(0.5, 0.3, 0.2);
    let wrong = Pose2::new(0.1, 0.0, 0.0) * truth;
    for i in 0..60 {
        live.insert(wrong, &room.scan(truth, TAU, 720, 8.0, |beam| noise(i * 720 + beam)));
    }
    let scan = room.scan(truth, TAU, 2000, 6.0, |beam| noise(beam + 7_000_000));
    let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
    let guess = truth.interpolate(&wrong, 0.6);
    matcher
        .refine(live.matched_map(), &scan, guess)
        .map_or(f64::INFINITY, |found| found.pose.distance(&truth))
}

#[test]
fn a_scan_is_matched_to_a_given_map_and_not_to_what_was_drawn_over_it() {
    let error = error_after_wrong_drawing(LiveMapper::on_given);
    assert!(error < 0.03, "{error} m");
    let error = error_after_wrong_drawing(LiveMapper::from_grid);
    assert!(error > 0.05, "a map of one's own follows its drawing: {error} m");
}

#[test]
fn where_a_given_map_is_unknown_scans_are_matched_to_the_drawing() {
    let room = FlatRoom::furnished();
    let unknown = OccupancyGrid::filled(*map_of(&room, circle()).grid().geometry(), Cell::Unknown);
    let mut live = LiveMapper::on_given(MapperConfig::default(), &unknown).unwrap();
    for (i, pose) in circle().enumerate() {
        live.insert(pose, &room.scan(pose, TAU, 720, 8.0, |beam| noise(i * 720 + beam)));
    }
    let truth = Pose2::new(0.5, 0.3, 0.2);
    let scan = room.scan(truth, TAU, 2000, 6.0, |beam| noise(beam + 7_000_000));
    let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
    let guess = truth * Pose2::new(0.08, -0.05, 0.03);
    let found = matcher.refine(live.matched_map(), &scan, guess).unwrap();
    assert!(found.pose.distance(&truth) < 0.015 && found.score > 0.8, "{found:?}");
}

#[test]
fn an_object_that_a_given_map_lacks_does_not_count_against_a_match() {
    let (plain, room) = (FlatRoom::new(&[&WALLS]), FlatRoom::furnished());
    let known = map_of(&plain, circle());
    let mut live = LiveMapper::on_given(MapperConfig::default(), known.grid()).unwrap();
    let truth = Pose2::new(0.5, 0.3, 0.2);
    let scan = |seed: usize| room.scan(truth, TAU, 720, 8.0, |beam| noise(seed * 720 + beam));
    let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
    let guess = truth * Pose2::new(0.05, -0.05, 0.02);
    let before = matcher.refine(live.matched_map(), &scan(0), guess).map_or(0.0, |found| found.score);
    (0..20).for_each(|i| _ = live.insert(truth, &scan(i)));
    let found = matcher.refine(live.matched_map(), &scan(20), guess).unwrap();
    assert!(found.pose.distance(&truth) < 0.03, "{found:?}");
    assert!(found.score > before && found.score > 0.8, "{} after {before}", found.score);
}

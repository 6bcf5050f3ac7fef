//! Laws of the inverse sensor model: evidence of one cell, mirror images, and scans taken in two halves.

use crate::flat_room::FlatRoom;
use proptest::prelude::*;
use std::f64::consts::TAU;
use trundle_core::{Beam, Cell, Pose2, Scan, Stamp, Vector2};
use trundle_mapping::{GridMapper, MapperConfig};

/// A point of the wall of [`wall`], m.
const WALL: Vector2 = Vector2::new(2.01, 0.01);

/// Three beams onto one cell, 2.01 m ahead: hits or free rays.
fn wall(is_hit: bool) -> Scan {
    let beam = if is_hit { Beam::Hit { range: 2.01 } } else { Beam::Free { range: 3.0 } };
    Scan::new(Stamp::default(), Vector2::zeros(), 0.001, 0.001, vec![beam; 3]).unwrap()
}

/// A map without blind range and surface gap: each beam counts by itself.
fn plain() -> GridMapper {
    let mut config = MapperConfig::default();
    (config.blind_range, config.surface_gap) = (0.0, 0.0);
    GridMapper::new(config).unwrap()
}

/// Log-odds in a square of 12 m around the origin, row by row.
fn all_log_odds(mapper: &GridMapper) -> Vec<f64> {
    let at = |i: usize| Vector2::new(-5.975 + 0.05 * (i % 240) as f64, -5.975 + 0.05 * (i / 240) as f64);
    (0..240 * 240).map(|i| mapper.log_odds_at(at(i))).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Each hit raises the probability of its cell, each free ray lowers it, and both stop at the clamps.
    #[test]
    fn a_hit_never_lowers_a_probability_and_a_free_ray_never_raises_it(
        hits in prop::collection::vec(any::<bool>(), 1..60),
    ) {
        let mut mapper = plain();
        let limits = (mapper.config().clamp_low, mapper.config().clamp_high);
        let (mut before, mut expected) = (0.0_f64, 0.0_f64);
        for is_hit in hits {
            mapper.insert(Pose2::IDENTITY, &wall(is_hit));
            expected = (expected + if is_hit { 0.85 } else { -0.4 }).clamp(-limits.0, limits.1);
            let now = mapper.log_odds_at(WALL);
            let moves = if is_hit { now > before || now == limits.1 } else { now < before || now == -limits.0 };
            prop_assert!(moves, "{before} to {now}");
            prop_assert!((now - expected).abs() < 1e-4, "{now} against {expected}");
            let odds = mapper.probability_at(WALL) / (1.0 - mapper.probability_at(WALL));
            prop_assert!((odds.ln() - now).abs() < 1e-6);
            before = now;
        }
    }

    /// The published class has the thresholds of the configuration: a cell is unknown between them.
    #[test]
    fn the_published_class_follows_the_probability(hits in prop::collection::vec(any::<bool>(), 1..40)) {
        let mut mapper = plain();
        for is_hit in hits {
            mapper.insert(Pose2::IDENTITY, &wall(is_hit));
            let probability = mapper.probability_at(WALL);
            let is_right = match mapper.grid().at(WALL) {
                Cell::Occupied => probability > 0.65,
                Cell::Free => probability < 0.196,
                Cell::Unknown => (0.196..=0.65).contains(&probability),
            };
            prop_assert!(is_right, "{:?} at {probability}", mapper.grid().at(WALL));
        }
    }

    /// A room mirrored in the robot's axis gives the mirrored map.
    #[test]
    fn a_mirrored_scan_draws_the_mirrored_map(x in -0.9..0.9_f64, theta in -3.0..3.0_f64) {
        let seen = FlatRoom::furnished().scan(Pose2::new(x, 0.3, theta), 4.0, 301, 5.0, |_| 0.0);
        let mirrored: Vec<Beam> = seen.beams().iter().rev().copied().collect();
        let first = -seen.angle(seen.beams().len() - 1);
        let mirrored = Scan::new(Stamp::default(), Vector2::zeros(), first, seen.angle_increment(), mirrored);
        let (mut one, mut other) = (plain(), plain());
        // The axis of the mirror is a border of cells.
        one.insert(Pose2::new(0.013, 0.0, 0.0), &seen);
        other.insert(Pose2::new(0.013, 0.0, 0.0), &mirrored.unwrap());
        let (one, other) = (all_log_odds(&one), all_log_odds(&other));
        let mirror = |i: usize| (239 - i / 240) * 240 + i % 240;
        let differ = (0..one.len()).filter(|i| one[*i] != other[mirror(*i)]).count();
        prop_assert!(one.iter().filter(|value| **value != 0.0).count() > 2_000);
        prop_assert!(differ <= 4, "{differ} cells differ by rounding at their borders");
    }

    /// The cells known from a scan are those known from its two halves, and a hit of the whole scan is a hit of a half.
    #[test]
    fn two_halves_of_a_scan_see_what_the_whole_scan_sees(y in 0.1..1.4_f64, theta in -3.0..3.0_f64, at in 1..359_usize) {
        let pose = Pose2::new(-0.4, y, theta);
        let scan = FlatRoom::furnished().scan(pose, TAU, 360, 8.0, |_| 0.0);
        let part = |keep: &dyn Fn(usize) -> bool| {
            let beam = |(i, beam): (usize, &Beam)| if keep(i) { *beam } else { Beam::Unseen };
            let beams = scan.beams().iter().enumerate().map(beam).collect();
            Scan::new(Stamp::default(), Vector2::zeros(), scan.angle_min(), scan.angle_increment(), beams).unwrap()
        };
        let drawn = |scans: &[Scan]| {
            let mut mapper = plain();
            let hits: usize = scans.iter().map(|scan| mapper.insert(pose, scan).hits).sum();
            (all_log_odds(&mapper), hits)
        };
        let (whole, whole_hits) = drawn(&[part(&|_| true)]);
        let halves = [part(&|i| i < at), part(&|i| i >= at)];
        let (by_halves, half_hits) = drawn(&halves);
        let [(first, _), (second, _)] = [drawn(&halves[..1]), drawn(&halves[1..])];
        prop_assert!(whole_hits <= half_hits && half_hits <= whole_hits + 2, "{half_hits} hits of {whole_hits}");
        for i in 0..whole.len() {
            prop_assert_eq!(whole[i] != 0.0, first[i] != 0.0 || second[i] != 0.0);
            prop_assert_eq!(whole[i] > 0.0, first[i] > 0.0 || second[i] > 0.0);
            prop_assert!((by_halves[i] - first[i] - second[i]).abs() < 1e-6, "evidence of two scans adds up");
        }
    }
}

/// A beam that ends at the limit of the range proves free space before the limit and no obstacle at it.
#[test]
fn a_truncated_ray_is_free_and_has_no_end() {
    let mut mapper = plain();
    let far = Scan::new(Stamp::default(), Vector2::zeros(), 0.001, 0.001, vec![Beam::Hit { range: 14.0 }; 3]);
    let done = mapper.insert(Pose2::IDENTITY, &far.unwrap());
    assert_eq!((done.hits, done.ignored_beams), (0, 0));
    assert!(mapper.log_odds_at(Vector2::new(11.9, 0.03)) < 0.0);
    assert_eq!(mapper.log_odds_at(Vector2::new(12.2, 0.03)), 0.0);
    assert_eq!(mapper.log_odds_at(Vector2::new(14.0, 0.03)), 0.0);
}

/// A pose or a point that is no number changes no cell.
#[test]
fn a_pose_that_is_not_finite_draws_nothing() {
    let mut mapper = plain();
    let (x, y, theta) = (0.0, 0.0, 0.0);
    for pose in [
        Pose2 { x: f64::NAN, y, theta },
        Pose2 { x, y: f64::INFINITY, theta },
        Pose2 { x, y, theta: f64::NAN },
    ] {
        let done = mapper.insert(pose, &wall(true));
        assert_eq!((done.hits, done.free, done.ignored_beams), (0, 0, 3), "{pose:?}");
    }
    assert!(mapper.grid().cells().iter().all(|cell| *cell == Cell::Unknown));
}

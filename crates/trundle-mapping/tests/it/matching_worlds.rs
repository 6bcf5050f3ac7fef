//! Scan matches in worlds that determine all, some or none of the directions.

use crate::flat_room::FlatRoom;
use std::f64::consts::TAU;
use trundle_core::{Pose2, Scan, Vector2, wrap_angle};
use trundle_mapping::{GridMapper, MapperConfig, ScanMatch, ScanMatchConfig, ScanMatcher};

/// Two arms of a corridor 1.6 m wide that meet at a right angle, 12 m and 9 m long.
fn l_shaped() -> FlatRoom {
    FlatRoom::new(&[&[(-10.0, -0.8), (2.0, -0.8), (2.0, 9.0), (0.4, 9.0), (0.4, 0.8), (-10.0, 0.8)]])
}

/// Scan with 5 mm of uniform error, and a range of 5 m.
fn scan(room: &FlatRoom, pose: Pose2, seed: u64) -> Scan {
    let error =
        |beam: usize| (crate::boxes::mix(seed << 16 ^ beam as u64) >> 11) as f64 / 2_f64.powi(53) - 0.5;
    room.scan(pose, TAU, 900, 5.0, |beam| 0.01 * error(beam))
}

/// The map of both arms.
fn mapped(room: &FlatRoom) -> GridMapper {
    let mut mapper = GridMapper::new(MapperConfig::default()).unwrap();
    let along = (0..60).map(|i| Pose2::new(-9.0 + 0.17 * f64::from(i), 0.0, 0.2 * f64::from(i)));
    let up = (0..50).map(|i| Pose2::new(1.2, 0.16 * f64::from(i), 0.3 * f64::from(i)));
    for (i, pose) in along.chain(up).enumerate() {
        mapper.insert(pose, &scan(room, pose, i as u64));
    }
    mapper
}

fn matched(mapper: &GridMapper, scan: &Scan, guess: Pose2) -> Option<ScanMatch> {
    ScanMatcher::new(ScanMatchConfig::default()).unwrap().refine(mapper, scan, guess)
}

/// Standard deviation of the position along a direction of the map, m.
fn sigma(found: &ScanMatch, direction: Vector2) -> f64 {
    let own = found.pose.inverse().rotate(direction);
    (own.transpose() * found.covariance.fixed_view::<2, 2>(0, 0) * own)[(0, 0)].sqrt()
}

/// At the bend both arms are in view: any displacement within the window is recovered.
#[test]
fn at_the_bend_every_displacement_is_recovered() {
    let room = l_shaped();
    let mapper = mapped(&room);
    for k in 0..24 {
        let truth = Pose2::new(1.1, 0.2, TAU * f64::from(k) / 24.0 - 3.0);
        let direction = f64::from(k) * 2.4;
        let wrong =
            Pose2::new(0.13 * direction.cos(), 0.13 * direction.sin(), 0.09 * (3.1 * direction).sin());
        let found = matched(&mapper, &scan(&room, truth, 900 + k as u64), truth * wrong).unwrap();
        let turned = wrap_angle(found.pose.theta - truth.theta).abs();
        assert!(
            !found.degenerate && found.pose.distance(&truth) < 0.015 && turned < 0.005,
            "{truth:?} {found:?}"
        );
        assert!(
            sigma(&found, Vector2::x()) < 0.03 && sigma(&found, Vector2::y()) < 0.03,
            "{}",
            found.covariance
        );
    }
}

/// In an arm longer than the range the position along it stays that of the guess, with a large variance, whichever way the arm runs.
#[test]
fn in_each_arm_the_direction_of_the_arm_is_uncertain() {
    let room = l_shaped();
    let mapper = mapped(&room);
    for (truth, along) in
        [(Pose2::new(-4.8, 0.1, 0.4), Vector2::x()), (Pose2::new(-4.8, 0.1, 2.9), Vector2::x())]
    {
        let across = Vector2::new(-along.y, along.x);
        let off = along * 0.1 + across * 0.05;
        let guess = Pose2::new(truth.x + off.x, truth.y + off.y, truth.theta + 0.04);
        let found = matched(&mapper, &scan(&room, truth, 77), guess).unwrap();
        let from_truth = found.pose.position() - truth.position();
        assert!(found.degenerate, "{found:?}");
        assert!(
            (from_truth.dot(&along) - 0.1).abs() < 0.03,
            "the guess is kept along the arm: {from_truth:?}"
        );
        assert!(from_truth.dot(&across).abs() < 0.015 && (found.pose.theta - truth.theta).abs() < 0.006);
        assert!(sigma(&found, along) > 10.0 * sigma(&found, across), "{}", found.covariance);
    }
}

/// The end wall of the arm determines the position along it as soon as the wall is in range.
#[test]
fn an_end_wall_in_range_ends_the_uncertainty() {
    let room = l_shaped();
    let mapper = mapped(&room);
    let sigma_along = |x: f64| {
        let truth = Pose2::new(x, 0.05, 0.0);
        let found = matched(&mapper, &scan(&room, truth, 5), truth * Pose2::new(0.08, 0.0, 0.02)).unwrap();
        (found.degenerate, sigma(&found, Vector2::x()), found.pose.distance(&truth))
    };
    let ((middle, wide, _), (end, narrow, off)) = (sigma_along(-4.8), sigma_along(-8.6));
    assert!(middle && !end && off < 0.015, "{off} m");
    assert!(wide > 10.0 * narrow, "{wide} m in the middle, {narrow} m near the end");
}

/// Information adds up: a scan of more of the room is never less certain.
#[test]
fn a_wider_view_is_not_less_certain() {
    let room = FlatRoom::furnished();
    let mut mapper = GridMapper::new(MapperConfig::default()).unwrap();
    for i in 0..40 {
        let t = TAU * f64::from(i) / 40.0;
        let pose = Pose2::new(2.3 * t.cos(), 1.4 * t.sin(), t);
        mapper.insert(pose, &scan(&room, pose, i as u64));
    }
    let truth = Pose2::new(0.4, -0.7, -0.6);
    let traces = [1.6_f64, 2.4, 3.2, 4.8, TAU].map(|view| {
        let beams = (view * 140.0) as usize;
        let found = matched(&mapper, &room.scan(truth, view, beams, 6.0, |_| 0.0), truth).unwrap();
        assert!(!found.degenerate && found.pose.distance(&truth) < 0.02, "{view}: {found:?}");
        sigma(&found, Vector2::x()).powi(2) + sigma(&found, Vector2::y()).powi(2)
    });
    assert!(traces.windows(2).all(|pair| pair[1] < pair[0]), "{traces:?}");
}

/// A scan of another room is refused by its score, and passes where the limit is 0.
#[test]
fn a_scan_of_another_room_is_refused_by_its_score() {
    let (here, other) = (l_shaped(), FlatRoom::furnished());
    let mapper = mapped(&here);
    let foreign = other.scan(Pose2::new(0.0, 0.3, 0.4), TAU, 900, 5.0, |_| 0.0);
    let guess = Pose2::new(1.1, 0.2, 0.4);
    assert_eq!(matched(&mapper, &foreign, guess), None);
    let mut score = 0.0;
    for x in [-3.0, -1.0, 1.1] {
        let mut config = ScanMatchConfig::default();
        (config.min_score, config.window) = (0.0, 0.5);
        let found = ScanMatcher::new(config).unwrap().refine(&mapper, &foreign, Pose2 { x, ..guess });
        score = found.map_or(score, |found| f64::max(score, found.score));
    }
    assert!((0.0..0.6).contains(&score), "{score}");
}

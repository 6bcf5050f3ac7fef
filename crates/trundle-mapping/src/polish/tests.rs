//! Laws of the polish.

use super::pair::{MatchModel, PairEquations};
use super::polished;
use super::surface_scan::SurfaceScan;
use crate::loop_closing::scan_history::ScanHistory;
use crate::loop_closing::stored_scan::StoredScan;
use crate::particle_config::ParticleConfig;
use crate::scan_match::scan_points::ScanPoints;
use crate::scan_match::tests::room;
use nalgebra::Matrix3;
use std::f64::consts::{PI, TAU};
use trundle_core::{Beam, Pose2, Scan, Stamp, Vector2, difference_of_angles};

fn points(config: &ParticleConfig, scan: &Scan) -> ScanPoints {
    let mut points = ScanPoints::default();
    points.set(config, scan);
    points
}

/// Two laps in the room, with the poses that a filter might have, and its steps.
fn laps(config: &ParticleConfig, carried: Option<usize>) -> (Vec<Pose2>, Vec<Pose2>, ScanHistory) {
    let (mut truth, mut poses, mut history) = (Vec::new(), Vec::new(), ScanHistory::default());
    for k in 0..60_u32 {
        let angle = TAU * f64::from(k) / 30.0;
        let pose = Pose2::new(1.4 * angle.cos() - 0.4, 1.2 * angle.sin(), angle + 0.5 * PI);
        let error = |seed: u32| if k == 0 { 0.0 } else { f64::from((k * seed) % 21) / 10.0 - 1.0 };
        poses.push(pose * Pose2::new(0.04 * error(8), 0.04 * error(13), 0.01 * error(5)));
        truth.push(pose);
        let seen = if carried == Some(k as usize) { corridor() } else { room::scan(pose) };
        history.push(StoredScan::new(config, &points(config, &seen)), Matrix3::identity() * 1e-3);
    }
    (truth, poses, history)
}

/// A scan in a straight corridor, 2 m wide, along x.
fn corridor() -> Scan {
    let beam = |k: usize| {
        let range = 1.0 / (k as f64 * TAU / 360.0).sin().abs();
        if range < 8.0 { Beam::Hit { range } } else { Beam::Unseen }
    };
    Scan::new(Stamp::default(), Vector2::zeros(), 0.0, TAU / 360.0, (0..360).map(beam).collect()).unwrap()
}

/// Largest error of the poses, m and rad.
fn error(poses: &[Pose2], truth: &[Pose2], but: Option<usize>) -> (f64, f64) {
    let pairs = poses.iter().zip(truth).enumerate().filter(|(k, _)| Some(*k) != but);
    pairs.fold((0.0, 0.0), |(far, turn), (_, (a, b))| {
        (a.distance(b).max(far), difference_of_angles(a.theta, b.theta).abs().max(turn))
    })
}

#[test]
fn the_poses_of_two_laps_become_those_of_the_truth() {
    let config = ParticleConfig::default();
    let (truth, poses, history) = laps(&config, None);
    let before = error(&poses, &truth, None);
    assert!(before.0 > 0.04 && before.1 > 0.009, "{before:?}");
    let after = error(&polished(&config, &history, &poses, &|| true).unwrap(), &truth, None);
    assert!(after.0 < 0.006 && after.1 < 0.002, "{after:?}");
}

#[test]
fn a_scan_of_another_place_does_not_displace_the_others() {
    let config = ParticleConfig::default();
    let (truth, poses, history) = laps(&config, Some(17));
    let after = error(&polished(&config, &history, &poses, &|| true).unwrap(), &truth, Some(17));
    assert!(after.0 < 0.01 && after.1 < 0.003, "{after:?}");
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let config = ParticleConfig::default();
    let (_, poses, history) = laps(&config, None);
    let by = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| polished(&config, &history, &poses, &|| true)).unwrap()
    };
    assert_eq!(by(1), by(4));
}

#[test]
fn a_corridor_holds_no_position_along_it_and_keeps_the_steps_of_the_filter() {
    let config = ParticleConfig::default();
    let scan = SurfaceScan::new(Vector2::zeros(), &points(&config, &corridor()).hits(&config));
    let model = MatchModel { scale: 0.1, min_scale_sigmas: 3.0, correlation: 4.0, degenerate_below: 0.01 };
    let equations = PairEquations::new(&scan, &scan, Pose2::new(0.3, 0.02, 0.0), &model);
    assert!(equations.matched > 200.0 && equations.contradicted == 0.0);
    assert!(equations.information[(0, 0)] < 1e-6 * equations.information[(1, 1)]);
    assert!(equations.rhs.x.abs() < 1e-6 * equations.rhs.y.abs(), "{}", equations.rhs);

    let mut history = ScanHistory::default();
    let stored = StoredScan::new(&config, &points(&config, &corridor()));
    let poses: Vec<Pose2> = (0..40).map(|k| Pose2::new(0.3 * f64::from(k), 0.0, 0.0)).collect();
    poses.iter().for_each(|_| history.push(stored.clone(), Matrix3::identity() * 1e-3));
    let (far, turn) =
        polished(&config, &history, &poses, &|| true).map_or((0.0, 0.0), |after| error(&after, &poses, None));
    assert!(far < 1e-3 && turn < 1e-4, "{far} m, {turn} rad");
}

#[test]
fn an_empty_history_and_one_scan_stay_as_they_are() {
    let config = ParticleConfig::default();
    let (_, poses, mut history) = laps(&config, None);
    history.truncate(1);
    assert_eq!(polished(&config, &history, &poses[..1], &|| true), None);
    history.truncate(0);
    assert_eq!(polished(&config, &history, &[], &|| true), None);
}

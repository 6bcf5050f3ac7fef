//! The gate that selects scans: distance, turn, time, and impossible odometry.

use crate::particle_config::ParticleConfig;
use crate::rbpf::scan_update::Refusal;
use crate::rbpf::update_gate::{OdometryStep, UpdateGate};
use proptest::prelude::*;
use trundle_core::{Beam, Pose2, Scan, Stamp, Vector2};

fn scan(at_s: f64) -> Scan {
    let stamp = Stamp::from_nanos((at_s * 1e9) as i64);
    Scan::new(stamp, Vector2::zeros(), 0.0, 0.1, vec![Beam::Hit { range: 2.0 }; 3]).unwrap()
}

/// A gate after its first scan, at 1 s and the origin.
fn opened() -> UpdateGate {
    let mut gate = UpdateGate::default();
    let first = pass(&mut gate, Pose2::IDENTITY, 1.0).unwrap().unwrap();
    assert!(first.first && first.motion == Pose2::IDENTITY && !first.jumped);
    gate
}

fn pass(gate: &mut UpdateGate, pose: Pose2, at_s: f64) -> Result<Option<OdometryStep>, Refusal> {
    gate.pass(&ParticleConfig::default(), false, pose, &scan(at_s))
}

proptest! {
    /// 0.3 m, 10 degrees or 2 s since the last processed scan.
    #[test]
    fn a_scan_passes_after_enough_distance_turn_or_time(
        distance in 0.0..0.6_f64, heading in -3.0..3.0_f64, turn_deg in -20.0..20.0_f64, after in 0.0..4.0_f64,
    ) {
        let close = |value: f64, gate: f64| (value - gate).abs() < 1e-6;
        prop_assume!(!close(distance, 0.3) && !close(turn_deg.abs(), 10.0) && !close(after, 2.0));
        let pose = Pose2::new(distance * heading.cos(), distance * heading.sin(), turn_deg.to_radians());
        let step = pass(&mut opened(), pose, 1.0 + after).unwrap();
        prop_assert_eq!(step.is_some(), distance > 0.3 || turn_deg.abs() > 10.0 || after > 2.0);
        if let Some(step) = step {
            prop_assert!(step.motion.distance(&pose) < 1e-12 && !step.first);
        }
    }

    /// Steps below the gates add up: no motion is lost.
    #[test]
    fn the_steps_of_processed_scans_compose_to_the_whole_motion(
        steps in prop::collection::vec((0.0..0.25_f64, -0.15..0.15_f64), 1..60),
    ) {
        let (mut gate, mut odom, mut sum) = (opened(), Pose2::IDENTITY, Pose2::IDENTITY);
        let mut processed = odom;
        for (k, (x, theta)) in steps.iter().enumerate() {
            odom = odom * Pose2::new(*x, 0.0, *theta);
            if let Some(step) = pass(&mut gate, odom, 1.0 + 0.1 * k as f64).unwrap() {
                sum = sum * step.motion;
                processed = odom;
            }
        }
        prop_assert!(sum.distance(&processed) < 1e-9);
    }

    #[test]
    fn a_refused_pose_leaves_the_gate_as_it_was(x in -0.5..0.5_f64, kind in 0..4_usize) {
        let (mut clean, mut hit) = (opened(), opened());
        let (pose, at) = [
            (Pose2 { x: f64::NAN, ..Pose2::IDENTITY }, 2.0),
            (Pose2 { theta: f64::INFINITY, ..Pose2::IDENTITY }, 2.0),
            (Pose2::new(2e6, 0.0, 0.0), 2.0),
            (Pose2::IDENTITY, 0.5),
        ][kind];
        let expected =
            [Refusal::NotFinite, Refusal::NotFinite, Refusal::OutOfReach, Refusal::TimeGoesBack][kind];
        prop_assert_eq!(pass(&mut hit, pose, at).err(), Some(expected));
        let next = Pose2::new(x, 0.0, 0.0);
        let (a, b) = (pass(&mut clean, next, 2.5).unwrap(), pass(&mut hit, next, 2.5).unwrap());
        prop_assert_eq!(a.map(|step| step.motion), b.map(|step| step.motion));
    }
}

#[test]
fn a_jump_of_dead_reckoning_is_not_motion_and_adds_uncertainty() {
    let step = pass(&mut opened(), Pose2::new(6.0, 0.0, 0.0), 1.5).unwrap().unwrap();
    assert!(step.jumped && step.motion == Pose2::IDENTITY);
    let usual = pass(&mut opened(), Pose2::new(0.5, 0.0, 0.0), 1.5).unwrap().unwrap();
    assert!(step.covariance.trace() > usual.covariance.trace());
}

#[test]
fn absolute_poses_that_jump_are_refused_until_five_agree() {
    let config = ParticleConfig::default();
    let mut gate = UpdateGate::default();
    let mut at =
        |x: f64, k: u32| gate.pass(&config, true, Pose2::new(x, 0.0, 0.0), &scan(1.0 + 0.1 * f64::from(k)));
    assert!(at(0.0, 0).is_ok());
    for k in 1..5 {
        assert_eq!(at(100.0, k).err(), Some(Refusal::OutOfReach));
    }
    assert!(at(100.0, 5).unwrap().is_some(), "the fifth that agrees");
    assert_eq!(at(0.0, 6).err(), Some(Refusal::OutOfReach), "the old place is now the wild one");
}

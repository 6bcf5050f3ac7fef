//! The pose controller near its goal.

use crate::plant::{DT, Plant};
use proptest::prelude::*;
use trundle_control::{Stabilizer, StabilizerConfig, StabilizerPhase};
use trundle_core::{DifferentialDrive, DriveLimits, Pose2};

/// Result of a run.
#[derive(Debug)]
struct Outcome {
    seconds: f64,
    /// Distance to the goal and heading error at the end, m and deg.
    error: (f64, f64),
    /// Number of sign changes of the speed.
    reversals: usize,
    /// Largest distance from the goal, m.
    farthest: f64,
    settled: bool,
}

fn settle(mut plant: Plant, goal: Pose2) -> Outcome {
    let mut stabilizer =
        Stabilizer::new(StabilizerConfig::default(), DifferentialDrive::KOBUKI, DriveLimits::KOBUKI).unwrap();
    let (mut settled_for, mut steps, mut reversals, mut sign, mut farthest) = (0, 0, 0, 0.0, 0.0_f64);
    while settled_for < 100 && steps < 2000 {
        let estimate = plant.estimate();
        let report = stabilizer.step(&estimate, goal, DT);
        plant.drive(report.twist);
        farthest = farthest.max(plant.pose.distance(&goal));
        if report.twist.v != 0.0 {
            reversals += usize::from(sign * report.twist.v < 0.0);
            sign = report.twist.v.signum();
        }
        settled_for = if report.phase == StabilizerPhase::Settled { settled_for + 1 } else { 0 };
        steps += 1;
    }
    let heading = trundle_core::difference_of_angles(plant.pose.theta, goal.theta).abs().to_degrees();
    Outcome {
        seconds: steps as f64 * DT - 2.0,
        error: (plant.pose.distance(&goal), heading),
        reversals,
        farthest,
        settled: settled_for >= 100,
    }
}

/// Every start within half a metre, on a coarse net.
fn starts() -> impl Iterator<Item = Pose2> {
    let net = |i: i32, n: i32| 2.0 * f64::from(i) / f64::from(n) - 1.0;
    (0..=6).flat_map(move |i| {
        (0..=6).flat_map(move |j| {
            (0..12)
                .map(move |k| Pose2::new(0.5 * net(i, 6), 0.5 * net(j, 6), std::f64::consts::PI * net(k, 12)))
        })
    })
}

#[test]
fn every_near_start_ends_within_the_tolerances() {
    let goal = Pose2::new(1.0, -2.0, 1.2);
    let (mut slowest, mut total, mut count) = (0.0_f64, 0.0, 0);
    for delay in [0.02, 0.04] {
        for start in starts() {
            let mut plant = Plant::at(goal * start);
            plant.delay = delay;
            let outcome = settle(plant, goal);
            assert!(outcome.settled, "{start:?}, delay {delay}: {outcome:?}");
            assert!(outcome.error.0 < 0.01 && outcome.error.1 < 0.5, "{start:?}, delay {delay}: {outcome:?}");
            assert!(outcome.reversals <= 1, "{start:?}, delay {delay}: {outcome:?}");
            assert!(outcome.farthest < start.position().norm() + 0.02, "{start:?}: {outcome:?}");
            slowest = slowest.max(outcome.seconds);
            total += outcome.seconds;
            count += 1;
        }
    }
    eprintln!("settled {count} times: mean {:.2} s, slowest {slowest:.2} s", total / f64::from(count));
    assert!(slowest < 12.0, "the slowest took {slowest} s");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn it_settles_with_noise(
        (x, y, theta) in (-0.3..0.3, -0.3..0.3, -3.1..3.1),
        noise in 0.0..0.004,
    ) {
        let goal = Pose2::new(0.3, 0.2, -2.0);
        let mut plant = Plant::at(goal * Pose2::new(x, y, theta));
        plant.noise = (noise, noise);
        let outcome = settle(plant, goal);
        prop_assert!(outcome.settled, "{:?}", outcome);
        prop_assert!(outcome.error.0 < 0.03 && outcome.error.1 < 1.5, "{:?}", outcome);
    }
}

#[test]
fn on_the_goal_it_stays_at_rest() {
    let goal = Pose2::new(1.0, 2.0, 3.0);
    let outcome = settle(Plant::at(goal), goal);
    assert!(outcome.settled && outcome.error == (0.0, 0.0) && outcome.seconds < 0.1, "{outcome:?}");
}

#[test]
fn a_new_goal_restarts_the_approach() {
    let mut stabilizer =
        Stabilizer::new(StabilizerConfig::default(), DifferentialDrive::KOBUKI, DriveLimits::KOBUKI).unwrap();
    let estimate = Plant::at(Pose2::IDENTITY).estimate();
    for _ in 0..3 {
        stabilizer.step(&estimate, Pose2::IDENTITY, DT);
    }
    assert_eq!(stabilizer.step(&estimate, Pose2::IDENTITY, DT).phase, StabilizerPhase::Settled);
    let elsewhere = Pose2::new(0.4, 0.0, 0.0);
    assert_eq!(stabilizer.step(&estimate, elsewhere, DT).phase, StabilizerPhase::Approaching);
}

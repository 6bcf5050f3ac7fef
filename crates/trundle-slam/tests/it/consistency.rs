//! Whether the covariances are consistent: over many runs with the noise that the configuration promises, the error of the pose
//! normalised by its covariance is that of a chi-square with six degrees of freedom [BarShalom01, sec. 5.4].

use crate::points::{Dice, Room, camera, darkness, reported, stamp};
use nalgebra::Vector6;
use trundle_core::Pose3;
use trundle_slam::{RgbdSlam, SlamConfig, TrackReport, Tracking};

const RUNS: u64 = 40;
/// Range for the mean of 40 runs: the 95 % band of the chi-square with 240 degrees of freedom, over 40.
const BAND: std::ops::Range<f64> = 4.97..7.13;

/// A run of the SLAM in the room of points.
struct Run<'a> {
    room: &'a Room,
    slam: RgbdSlam,
    dice: Dice,
    at: Pose3,
    number: usize,
}

impl<'a> Run<'a> {
    fn new(room: &'a Room, seed: u64, start: Pose3) -> Self {
        let slam = RgbdSlam::new(camera(), SlamConfig::default()).unwrap().starting_at(start);
        let mut run = Self { room, slam, dice: Dice(seed + 1000), at: start, number: 0 };
        run.step(start, false);
        run
    }

    /// Moves to the next pose, with wheel odometry; without an image if `is_dark`.
    fn step(&mut self, to: Pose3, is_dark: bool) -> TrackReport {
        let prior = reported(self.at.inverse() * to, &SlamConfig::default(), &mut self.dice);
        let (features, depth) = if is_dark { darkness() } else { self.room.seen_from(to, &mut self.dice) };
        let report = self.slam.step_with_features(stamp(self.number), features, &depth, Some(prior.into()));
        self.at = to;
        self.number += 1;
        report
    }

    /// The normalised squared error of a report.
    fn nees(&self, report: &TrackReport) -> f64 {
        let error = (self.at.inverse() * report.visual_from_camera).log();
        error.dot(&(report.covariance.try_inverse().unwrap() * error))
    }
}

fn mean_over_runs(of_run: impl Fn(u64) -> f64) -> f64 {
    let each: Vec<f64> = (0..RUNS).map(of_run).collect();
    let mean = each.iter().sum::<f64>() / RUNS as f64;
    let mut sorted = each;
    sorted.sort_by(f64::total_cmp);
    println!(
        "mean {mean:.2}, median {:.2}, largest {:.1}",
        sorted[RUNS as usize / 2],
        sorted[RUNS as usize - 1]
    );
    mean
}

/// A walk through the room with changing view directions.
fn walk(frame: usize) -> Pose3 {
    let t = frame as f64 / 90.0 * std::f64::consts::TAU;
    Pose3::exp(Vector6::new(0.5 * t.sin(), 0.05 * (2.0 * t).sin(), 0.4 - 0.4 * t.cos(), 0.0, 0.0, 0.0))
        * Pose3::exp(Vector6::new(0.0, 0.0, 0.0, 0.08 * (3.0 * t).sin(), 0.6 * t.sin(), 0.05 * t.sin()))
}

fn turned(frame: usize) -> Pose3 {
    Pose3::exp(Vector6::new(0.0, 0.0, 0.0, 0.0, frame as f64 / 100.0 * std::f64::consts::TAU, 0.0))
}

#[test]
fn the_covariance_is_consistent_while_tracked() {
    let room = Room::new();
    let mean = mean_over_runs(|seed| {
        let mut run = Run::new(&room, seed, walk(0));
        let reports: Vec<TrackReport> = (1..=45).map(|i| run.step(walk(i), false)).collect();
        let last = reports.last().unwrap();
        assert_eq!(last.tracking, Tracking::Ok, "seed {seed}");
        run.nees(last)
    });
    assert!(BAND.contains(&mean), "normalised squared error {mean}, expected within {BAND:?}");
}

#[test]
fn the_covariance_is_consistent_in_the_dark() {
    let room = Room::new();
    let mean = mean_over_runs(|seed| {
        let mut run = Run::new(&room, seed, walk(0));
        (1..=10).for_each(|i| _ = run.step(walk(i), false));
        let reports: Vec<TrackReport> = (11..=40).map(|i| run.step(walk(i), true)).collect();
        let last = reports.last().unwrap();
        assert_eq!(last.tracking, Tracking::DeadReckoning, "seed {seed}");
        run.nees(last)
    });
    assert!(BAND.contains(&mean), "normalised squared error {mean}, expected within {BAND:?}");
}

/// A full turn on the spot, partly in the dark: the last views show the places of the first ones.
#[test]
fn the_covariance_is_consistent_after_a_loop() {
    let room = Room::new();
    let mean = mean_over_runs(|seed| {
        let mut run = Run::new(&room, seed, turned(0));
        // One turn and one second, in which the whole map is refined.
        let steps = (1..=85).map(|i| run.step(turned(2 * i.min(54)), (12..22).contains(&i)));
        let reports: Vec<TrackReport> = steps.collect();
        let last = reports.last().unwrap();
        assert_eq!(last.tracking, Tracking::Ok, "seed {seed}");
        run.nees(last)
    });
    assert!(BAND.contains(&mean), "normalised squared error {mean}, expected within {BAND:?}");
}

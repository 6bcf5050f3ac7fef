//! Runs the SLAM over a recorded folder in the TUM layout, one image after the other: how accurate it is, and what it costs.
//!
//! `cargo run --release -p trundle-slam --example drive -- FOLDER [FRAMES] [--motion_unknown] [--seed=N] [--least-texture=X]` prints the frames located, loops, keyframes,
//! the ATE after a rigid alignment, how much of it is up and down, and median, 99th percentile and most of the processor
//! time, in ms, of the features alone, of a whole step, and of those that made keyframes. Wheels are used if the folder
//! has them, unless `--motion_unknown`; N is the seed of what is drawn at random, X `orb.min_texture`. Loading images is not timed. Without `camera.toml` the camera is that of freiburg1.
//! `TRUNDLE_FRAMES=FILE` writes of each frame: time, state, whether it is a keyframe, inliers; the error of the pose at its
//! time (m, rad, relative to the first one) with its standard deviation (m, rad) and normalised squared error (expected 6).
//! Then the error after all corrections (mm, aligned), and the processor time (ms).
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench program")]

#[path = "../tests/support/align.rs"]
mod align;
#[path = "../tests/support/drive.rs"]
mod drive;

use align::aligned;
use drive::Drive;
use nalgebra::Vector6;
use rustix::time::{ClockId, clock_gettime};
use std::fmt::Write;
use trundle_core::{Pose3, Vector3, gray_from_color};
use trundle_slam::{RgbdSlam, SlamConfig, TrackReport};
use trundle_vision::OrbExtractor;

fn main() {
    let (flags, args): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|arg| arg.starts_with("--"));
    let drive = Drive::open(args.first().expect("a folder with associations.txt"));
    let count = args.get(1).map_or(usize::MAX, |n| n.parse().unwrap()).min(drive.frames.len());
    let mut config = SlamConfig::default();
    let value = |name: &str| flags.iter().find_map(|flag| flag.strip_prefix(name));
    if let Some(seed) = value("--seed=") {
        config.seed = seed.parse().unwrap();
    }
    if let Some(min) = value("--least-texture=") {
        config.orb.min_texture = min.parse().unwrap();
    }
    let is_blind = flags.iter().any(|flag| flag == "--blind");
    let mut extractor = OrbExtractor::new(config.orb.clone()).unwrap();
    let mut slam = RgbdSlam::new(drive.camera, config).unwrap();
    let (mut features, mut kept, mut total) = (vec![], vec![], vec![]);
    let (mut located, mut loops, mut states) = (0, 0, vec![]);
    let mut drift = None;
    for i in 0..count {
        let image = drive.image(i);
        let start = processor_ms();
        extractor.extract(&gray_from_color(image.color()));
        let found_at = processor_ms();
        let prior = drive.wheels(i).filter(|_| !is_blind);
        let report = slam.step(&image, prior);
        let end = processor_ms();
        features.push(found_at - start);
        total.push(end - found_at);
        if report.new_keyframe {
            kept.push(end - found_at);
        }
        located += usize::from(report.tracking.is_located());
        if let Some(closed) = report.closed_loop {
            loops += 1;
            let (moved, turned) = (closed.correction.translation.norm(), closed.correction.angle());
            println!("frame {i}: loop of {} points, by {moved:.3} m and {turned:.4} rad", closed.points);
        }
        let live = off_since_start(&drive, i, report.visual_from_camera);
        if loops == 0 {
            drift = live.map(|off| (i, off.translation.norm())).or(drift);
        }
        states.push(state(&report, live));
    }
    println!(
        "{located} of {count} frames located, {loops} loops, {} keyframes made, {} in the map, {} landmarks",
        kept.len(),
        slam.keyframes().count(),
        slam.landmarks().count()
    );
    if let Some((last, off)) = drift {
        let trajectory = trajectory(&drive, last);
        let percent = 100.0 * off / trajectory.max(1e-9);
        println!("until the first loop: {off:.3} m off after {trajectory:.1} m, {percent:.2} %");
    }
    slam.finish_refining();
    judge(&drive, &slam, &states, &total);
    for (name, times) in
        [("features", &mut features), ("a step with these", &mut total), ("the same, keyframes", &mut kept)]
    {
        let [median, high, max] = [0.5, 0.99, 1.0].map(|share| part(times, share));
        println!("{name:>20}: median {median:6.2} ms, 99 % {high:6.2} ms, max {max:6.2} ms");
    }
}

/// Error of the pose of frame `i` at its time, relative to the first one.
fn off_since_start(drive: &Drive, i: usize, pose: Pose3) -> Option<Pose3> {
    let truth = drive.frames[0].truth?.inverse() * drive.frames[i].truth?;
    Some(truth.inverse() * pose)
}

/// How far the camera had gone at frame `last`, m.
fn trajectory(drive: &Drive, last: usize) -> f64 {
    let places: Vec<Vector3> =
        drive.frames[..=last].iter().filter_map(|frame| Some(frame.truth?.translation)).collect();
    places.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}

/// Output of `TRUNDLE_FRAMES` for a frame when it is there, `off` from the truth.
fn state(report: &TrackReport, off: Option<Pose3>) -> String {
    let off = off.map_or(Vector6::repeat(f64::NAN), |off| off.log());
    let sigma = |from: usize| report.covariance.fixed_view::<3, 3>(from, from).trace().sqrt();
    let information = report.covariance.try_inverse().unwrap_or_default();
    format!(
        "{:?} {} {} {:.4} {:.4} {:.4} {:.4} {:.1}",
        report.tracking,
        u8::from(report.new_keyframe),
        report.inliers,
        off.fixed_rows::<3>(0).norm(),
        off.fixed_rows::<3>(3).norm(),
        sigma(0),
        sigma(3),
        off.dot(&(information * off))
    )
}

/// The error of the trajectory against the truth.
fn judge(drive: &Drive, slam: &RgbdSlam, states: &[String], times: &[f64]) {
    let known = |(stamp, pose): &(_, Pose3)| {
        let i = drive.frames.binary_search_by_key(stamp, |frame| frame.stamp).ok()?;
        Some((i, pose.translation, drive.frames[i].truth?.translation))
    };
    let known: Vec<(usize, Vector3, Vector3)> = slam.trajectory().iter().filter_map(known).collect();
    let (estimate, truth): (Vec<Vector3>, Vec<Vector3>) = known.iter().map(|(_, e, t)| (*e, *t)).unzip();
    let trajectory: f64 = truth.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    let errors: Vec<Vector3> =
        aligned(&estimate, &truth).into_iter().zip(&truth).map(|(e, t)| e - t).collect();
    let rms = |part: &dyn Fn(&Vector3) -> f64| {
        (errors.iter().map(|e| part(e).powi(2)).sum::<f64>() / errors.len() as f64).sqrt() * 100.0
    };
    println!(
        "ATE {:.2} cm over {} frames and {trajectory:.1} m, {:.2} cm of it up and down",
        rms(&|e| e.norm()),
        errors.len(),
        rms(&|e| e.z)
    );
    if let Some(file) = std::env::var_os("TRUNDLE_FRAMES") {
        let mut text = String::new();
        for ((i, ..), e) in known.iter().zip(&errors) {
            let [x, y, z] = [e.x, e.y, e.z].map(|v| v * 1e3);
            let stamp = drive.frames[*i].stamp;
            writeln!(text, "{stamp} {} {x:.1} {y:.1} {z:.1} {:.2}", states[*i], times[*i]).unwrap();
        }
        std::fs::write(file, text).unwrap();
    }
}

/// Time of this process on the processors: others may be at work too.
fn processor_ms() -> f64 {
    let now = clock_gettime(ClockId::ProcessCPUTime);
    now.tv_sec as f64 * 1e3 + now.tv_nsec as f64 * 1e-6
}

fn part(times: &mut [f64], part: f64) -> f64 {
    times.sort_by(f64::total_cmp);
    let last = times.len().saturating_sub(1);
    times.get((part * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}

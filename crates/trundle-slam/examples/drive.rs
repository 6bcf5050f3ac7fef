//! Runs the SLAM over a recorded folder in the TUM layout, one image after the other: how accurate it is, and what it costs.
//!
//! `cargo run --release -p trundle-slam --example drive -- FOLDER [FRAMES] [--blind]` prints the frames located, loops, keyframes,
//! the ATE after a rigid alignment, how much of it is up and down, and median and 99th percentile of the processor time, in
//! ms, of the features, of the rest of a step (of all frames, of those that became keyframes), and of both together. Wheels are used where the folder
//! has them, unless `--blind`. Loading images is not timed. Without `camera.toml` the camera is that of freiburg1.
//! `TRUNDLE_FRAMES=FILE` writes time, state, error (mm) and time (ms) of each frame.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench program")]

#[path = "../tests/support/align.rs"]
mod align;
#[path = "../tests/support/drive.rs"]
mod drive;

use align::aligned;
use drive::Drive;
use rustix::time::{ClockId, clock_gettime};
use std::fmt::Write;
use trundle_core::{Vector3, gray_from_color};
use trundle_slam::{RgbdSlam, SlamConfig};
use trundle_vision::OrbExtractor;

fn main() {
    let (flags, args): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|arg| arg.starts_with("--"));
    let drive = Drive::open(args.first().expect("a folder with associations.txt"));
    let count = args.get(1).map_or(usize::MAX, |n| n.parse().unwrap()).min(drive.frames.len());
    let mut config = SlamConfig::default();
    config.motion.readout = drive.readout;
    let mut extractor = OrbExtractor::new(config.orb.clone()).unwrap();
    let mut slam = RgbdSlam::new(drive.camera, config).unwrap();
    let (mut features, mut rest, mut kept, mut total) = (vec![], vec![], vec![], vec![]);
    let (mut located, mut loops, mut states) = (0, 0, vec![]);
    for i in 0..count {
        let image = drive.image(i);
        let start = processor_ms();
        let found = extractor.extract(&gray_from_color(image.color()));
        let found_at = processor_ms();
        let prior = drive.wheels(i).filter(|_| flags.is_empty());
        let report = slam.step_with_features(image.stamp(), found, image.depth(), prior);
        let end = processor_ms();
        features.push(found_at - start);
        rest.push(end - found_at);
        total.push(end - start);
        if report.new_keyframe {
            kept.push(end - found_at);
        }
        located += usize::from(report.tracking.is_located());
        loops += usize::from(report.closed_loop.is_some());
        states.push(format!("{:?} {}", report.tracking, u8::from(report.new_keyframe)));
    }
    println!(
        "{located} of {count} frames located, {loops} loops, {} keyframes made, {} in the map, {} landmarks",
        kept.len(),
        slam.keyframes().count(),
        slam.landmarks().count()
    );
    slam.finish_refining();
    judge(&drive, &slam, &states, &total);
    for (name, times) in [
        ("features", &mut features),
        ("the rest of a step", &mut rest),
        ("the same, keyframes", &mut kept),
        ("together", &mut total),
    ] {
        let [median, high, most] = [0.5, 0.99, 1.0].map(|share| part(times, share));
        println!("{name:>20}: median {median:6.2} ms, 99 % {high:6.2} ms, most {most:6.2} ms");
    }
}

/// The error of the trajectory against the truth.
fn judge(drive: &Drive, slam: &RgbdSlam, states: &[String], times: &[f64]) {
    let known = |(stamp, pose): &(_, trundle_core::Pose3)| {
        let i = drive.frames.binary_search_by_key(stamp, |frame| frame.stamp).ok()?;
        Some((i, pose.translation, drive.frames[i].truth?.translation))
    };
    let known: Vec<(usize, Vector3, Vector3)> = slam.trajectory().iter().filter_map(known).collect();
    let (estimate, truth): (Vec<Vector3>, Vec<Vector3>) = known.iter().map(|(_, e, t)| (*e, *t)).unzip();
    let way: f64 = truth.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    let errors: Vec<Vector3> =
        aligned(&estimate, &truth).into_iter().zip(&truth).map(|(e, t)| e - t).collect();
    let rms = |part: &dyn Fn(&Vector3) -> f64| {
        (errors.iter().map(|e| part(e).powi(2)).sum::<f64>() / errors.len() as f64).sqrt() * 100.0
    };
    println!(
        "ATE {:.2} cm over {} frames and {way:.1} m, {:.2} cm of it up and down",
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

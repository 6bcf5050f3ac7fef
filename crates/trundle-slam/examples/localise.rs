//! How far localise-only is from the mapping run, on the very images that the map was made of.
//!
//! `cargo run --release -p trundle-slam --example localise -- FOLDER [SEEDS] [FRAMES] [--without-wheels]` maps a TUM RGB-D folder, saves and
//! loads the map, follows the same images in it, and compares each frame with the trajectory of the mapping run after all refinement;
//! once for each of the seeds 1 to SEEDS (default 10). `TRUNDLE_FRAMES=FOLDER` writes a table of the frames for each seed.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program for the terminal")]

#[path = "../tests/support/align.rs"]
mod align;
#[path = "../tests/support/drive.rs"]
mod drive;

use align::aligned_rmse;
use drive::Drive;
use std::collections::BTreeMap;
use std::fmt::Write;
use trundle_core::{CameraMotion, DepthImage, Pose3, Stamp, Vector3, gray_from_color};
use trundle_slam::{Mode, RgbdSlam, SlamConfig, TrackReport, Tracking};
use trundle_vision::{Features, OrbExtractor};

/// Difference of positions that is counted as off, m: the goal of localise-only. Source: ours.
const OFF_M: f64 = 0.01;

/// One image, with its features.
struct View {
    stamp: Stamp,
    features: Features,
    depth: DepthImage,
    motion: Option<CameraMotion>,
}

fn main() {
    let (flags, args): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|arg| arg.starts_with("--"));
    let drive = Drive::open(args.first().expect("a folder with associations.txt"));
    let seeds = args.get(1).map_or(10, |n| n.parse().unwrap());
    let frames = args.get(2).map_or(usize::MAX, |n| n.parse().unwrap()).min(drive.frames.len());
    let has_wheels = !flags.iter().any(|flag| flag == "--without-wheels");
    let mut extractor = OrbExtractor::new(SlamConfig::default().orb).unwrap();
    let views: Vec<View> = (0..frames)
        .map(|i| {
            let image = drive.image(i);
            let features = extractor.extract(&gray_from_color(image.color()));
            let motion = drive.wheels(i).filter(|_| has_wheels);
            View { stamp: image.stamp(), features, depth: image.depth().clone(), motion }
        })
        .collect();
    println!("seed  mean cm  max cm  frames off  longest run  ok  weak  not located  sigma mm  sigma max mm");
    (1..=seeds).for_each(|seed| judge(&drive, &views, seed));
}

fn step(slam: &mut RgbdSlam, view: &View) -> TrackReport {
    slam.step_with_features(view.stamp, view.features.clone(), &view.depth, view.motion)
}

/// Maps, localises in the map, and prints a line.
fn judge(drive: &Drive, views: &[View], seed: u64) {
    let mut config = SlamConfig::default();
    config.seed = seed;
    let mut mapping = RgbdSlam::new(drive.camera, config.clone()).unwrap();
    let mapped: Vec<TrackReport> = views.iter().map(|view| step(&mut mapping, view)).collect();
    mapping.finish_refining();
    let poses: BTreeMap<Stamp, Pose3> = mapping.trajectory().into_iter().collect();
    let mut slam = RgbdSlam::load(&mapping.save(), drive.camera, config).unwrap();
    slam.set_mode(Mode::Localisation);
    let found: Vec<TrackReport> = views.iter().map(|view| step(&mut slam, view)).collect();
    let off = |report: &TrackReport| {
        let before = poses.get(&report.stamp).filter(|_| report.tracking.is_located())?;
        Some((before.translation - report.visual_from_camera.translation).norm())
    };
    let offs: Vec<Option<f64>> = found.iter().map(off).collect();
    print_line(seed, &found, &offs);
    if let Some((mapped, found)) = errors(drive, &poses, &found) {
        println!("      against the truth: mapping run {mapped:.2} cm, localise-only {found:.2} cm");
    }
    if let Some(folder) = std::env::var_os("TRUNDLE_FRAMES") {
        let path = std::path::Path::new(&folder).join(format!("seed{seed}.txt"));
        std::fs::write(path, table(&mapped, &found, &offs)).unwrap();
    }
}

/// Errors of the mapping run and of localise-only against the truth, cm, root mean square over the frames that both located, each
/// aligned; `None` without a truth.
fn errors(drive: &Drive, poses: &BTreeMap<Stamp, Pose3>, found: &[TrackReport]) -> Option<(f64, f64)> {
    let located = found.iter().zip(&drive.frames).filter(|(report, _)| report.tracking.is_located());
    let known = located.filter_map(|(report, frame)| {
        let pose = poses.get(&report.stamp)?;
        Some((pose.translation, (report.visual_from_camera.translation, frame.truth?.translation)))
    });
    let (mapped, (found, truth)): (Vec<Vector3>, (Vec<Vector3>, Vec<Vector3>)) = known.unzip();
    let rmse = |estimate: &[Vector3]| 100.0 * aligned_rmse(estimate, &truth);
    (!truth.is_empty()).then(|| (rmse(&mapped), rmse(&found)))
}

fn print_line(seed: u64, found: &[TrackReport], offs: &[Option<f64>]) {
    let count = |state: Tracking| found.iter().filter(|report| report.tracking == state).count();
    let known: Vec<f64> = offs.iter().flatten().copied().collect();
    let is_off = |off: &Option<f64>| off.is_some_and(|off| off > OFF_M);
    let longest = offs.split(|off| !is_off(off)).map(<[_]>::len).max().unwrap_or(0);
    let (ok, weak) = (count(Tracking::Ok), count(Tracking::Weak));
    let located = found.iter().filter(|report| report.tracking.is_located());
    let mut sigmas: Vec<f64> = located.map(sigma_mm).collect();
    sigmas.sort_by(f64::total_cmp);
    println!(
        "{seed:4}  {:7.2}  {:6.2}  {:10}  {longest:11}  {ok}  {weak}  {:11}  {:8.1}  {:.1}",
        100.0 * known.iter().sum::<f64>() / known.len() as f64,
        100.0 * known.iter().copied().fold(0.0, f64::max),
        offs.iter().filter(|off| is_off(off)).count(),
        found.len() - ok - weak,
        sigmas[sigmas.len() / 2],
        sigmas[sigmas.len() - 1],
    );
}

/// Standard deviation of the position, mm.
fn sigma_mm(report: &TrackReport) -> f64 {
    1e3 * report.covariance.fixed_view::<3, 3>(0, 0).trace().sqrt()
}

/// A line a frame: number, state and points while mapping and since, off (mm), sigma (mm).
fn table(mapped: &[TrackReport], found: &[TrackReport], offs: &[Option<f64>]) -> String {
    let mut text = String::new();
    for (i, ((before, since), off)) in mapped.iter().zip(found).zip(offs).enumerate() {
        writeln!(
            text,
            "{i} map {:?} {} of {}{} | {:?} {} of {}{} | off {:.1} mm sigma {:.1} mm",
            before.tracking,
            before.inliers,
            before.matches,
            if before.new_keyframe { " key" } else { "" },
            since.tracking,
            since.inliers,
            since.matches,
            if since.relocalised { " relocalised" } else { "" },
            1e3 * off.unwrap_or(f64::NAN),
            sigma_mm(since),
        )
        .unwrap();
    }
    text
}

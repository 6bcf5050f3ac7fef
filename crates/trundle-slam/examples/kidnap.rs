//! Kidnapped into a saved map: is the camera recognised, and never somewhere else?
//!
//! Maps one recorded drive (a TUM RGB-D folder of the simulator, with its wheels where it has `odometry.txt`), saves the map and
//! loads it. Then it takes random views of another drive through the same scene, each with up to 1 s of images after it, until
//! the camera is located. Printed: located views, wrongly located ones, and the cost of a frame.
//!
//! `cargo run --release -p trundle-slam --example kidnap -- MAPPED OTHER [VIEWS] [MAP_FILE]`; a MAP_FILE that exists is
//! used, else written.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program for the terminal")]

#[path = "../tests/support/drive.rs"]
mod drive;

use drive::Drive;
use nalgebra::Matrix6;
use std::path::Path;
use std::time::Instant;
use trundle_core::Pose3;
use trundle_slam::{Mode, RgbdSlam, SlamConfig};

/// A view farther from all that was mapped is none of a mapped place: m, and rad. Source: ours.
const MAPPED: (f64, f64) = (0.5, 0.5);
/// A pose farther off than this is wrong: m, and rad. Source: ours.
const WRONG: (f64, f64) = (0.10, 0.0873);
/// How long the camera may look, s. Source: ours.
const PATIENCE: f64 = 1.0;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [mapped, other, rest @ ..] = &args[..] else {
        println!("kidnap MAPPED OTHER [VIEWS] [MAP_FILE]");
        return;
    };
    let views = rest.first().map_or(100, |views| views.parse().unwrap());
    let (mapped, other) = (Drive::open(mapped), Drive::open(other));
    let bytes = match rest.get(1) {
        Some(file) if Path::new(file).exists() => std::fs::read(file).unwrap(),
        file => {
            let bytes = map(&mapped);
            file.iter().for_each(|file| std::fs::write(file, &bytes).unwrap());
            bytes
        }
    };
    let start = Instant::now();
    let mut slam = RgbdSlam::load(&bytes, mapped.camera, SlamConfig::default()).unwrap();
    let loading = start.elapsed().as_secs_f64();
    println!(
        "{} keyframes, {:.1} MB, loaded in {loading:.2} s",
        slam.keyframes().count(),
        bytes.len() as f64 / 1e6
    );
    slam.set_mode(Mode::Localisation);
    kidnap(&mut slam, &mapped, &other, views);
    assert!(slam.save() == bytes, "localisation changed the map");
}

/// The map of a whole drive, in the frame of its truth.
fn map(drive: &Drive) -> Vec<u8> {
    let mut slam = RgbdSlam::new(drive.camera, SlamConfig::default()).unwrap().starting_at(drive.truth(0));
    let (mut located, mut worst, mut id) = (0, 0.0_f64, None);
    for i in 0..drive.frames.len() {
        let report = slam.step(&drive.image(i), drive.wheels(i));
        located += usize::from(report.tracking.is_located());
        let off = (drive.truth(i).inverse() * report.visual_from_camera).translation.norm();
        worst = worst.max(off);
        if id.replace(report.map) != Some(report.map) || !report.tracking.is_located() {
            println!("frame {i}: {:?} in {}, off by {off:.3} m", report.tracking, report.map);
        }
        if let Some(closed) = report.closed_loop {
            let moved = closed.correction.translation.norm();
            println!(
                "frame {i}: loop of {} points moved by {moved:.3} m, now off by {off:.3} m",
                closed.points
            );
        }
        if let Some(merged) = report.merged {
            println!(
                "frame {i}: {} is {} by {} points, off by {off:.3} m",
                merged.from, merged.into, merged.points
            );
        }
    }
    println!("mapped: {located} of {} frames located, off by {worst:.3} m at most", drive.frames.len());
    slam.save()
}

fn kidnap(slam: &mut RgbdSlam, mapped: &Drive, other: &Drive, views: usize) {
    let (mut recognized, mut wrong, mut at_once, mut draw) = (0, 0, 0, 12345_u64);
    let (mut costs, mut errors): (Vec<f64>, Vec<f64>) = Default::default();
    let mut seen = 0;
    while seen < views {
        draw = draw.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let first = (draw >> 33) as usize % other.frames.len();
        if !has_been_at(mapped, other.truth(first)) {
            continue;
        }
        seen += 1;
        slam.kidnapped();
        let until = other.frames[first].stamp.after(PATIENCE);
        let following = (first..other.frames.len()).take_while(|i| other.frames[*i].stamp <= until);
        let found = following.clone().find_map(|i| {
            let image = other.image(i);
            let start = Instant::now();
            let report = slam.step(&image, None);
            costs.push(start.elapsed().as_secs_f64() * 1e3);
            report.tracking.is_located().then_some((i, report))
        });
        let Some((i, report)) = found else {
            println!("view {first}: not recognised");
            continue;
        };
        let off = other.truth(i).inverse() * report.visual_from_camera;
        let is_wrong = off.translation.norm() > WRONG.0 || off.angle() > WRONG.1;
        if is_wrong {
            println!(
                "view {first}: WRONG by {:.3} m, {:.3} rad (standard deviation {:.3} m, squared error {:.0}), {} of {}",
                off.translation.norm(),
                off.angle(),
                report.covariance.fixed_view::<3, 3>(0, 0).trace().sqrt(),
                squared_error(off, &report.covariance),
                report.inliers,
                report.matches
            );
        }
        (recognized, wrong) = (recognized + 1, wrong + usize::from(is_wrong));
        errors.push(squared_error(off, &report.covariance));
        at_once += usize::from(i == first);
    }
    costs.sort_by(f64::total_cmp);
    errors.sort_by(f64::total_cmp);
    println!(
        "{recognized} of {views} views recognized, {at_once} of them at the first frame, {wrong} wrongly; a frame {:.1} ms \
         (median, features included), {:.1} ms at most; normalised squared errors {:.1} (median), {:.0} at most",
        costs[costs.len() / 2],
        costs[costs.len() - 1],
        errors.get(errors.len() / 2).unwrap_or(&f64::NAN),
        errors.last().unwrap_or(&f64::NAN),
    );
}

/// Of a pose that is off by `off`, normalised by its covariance: 6 expected.
fn squared_error(off: Pose3, covariance: &Matrix6<f64>) -> f64 {
    covariance.cholesky().map_or(f64::NAN, |factor| off.log().dot(&factor.solve(&off.log())))
}

fn has_been_at(drive: &Drive, pose: Pose3) -> bool {
    (0..drive.frames.len()).any(|i| {
        let offset = drive.truth(i).inverse() * pose;
        offset.translation.norm() < MAPPED.0 && offset.angle() < MAPPED.1
    })
}

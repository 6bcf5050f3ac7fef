//! Loops in drawn buildings, over several seeds: `cargo run --release -p trundle-mapping --example loop_bench -- [SEEDS] [PARTICLES]`
//!
//! Prints the agreement with the truth (relations of \[Kuemmerle09\]) of the filter's trajectory, and of the polished one.
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs, reason = "a measurement for the terminal")]

#[path = "../tests/it/boxes.rs"]
#[allow(dead_code, reason = "the tests use more of it")]
mod boxes;
#[path = "../tests/it/building.rs"]
mod building;
#[path = "carmen_bench/relations.rs"]
#[allow(dead_code, reason = "the benchmark of logs uses more of it")]
mod relations;

use building::{Building, Drive};
use relations::{Agreement, relations};
use std::time::Instant;
use trundle_core::{Pose2, Stamp};
use trundle_mapping::{ParticleConfig, ParticleMapper, ScanUpdate, propagate_trajectory};

/// Sums of the mean errors of drives: m, and deg.
#[derive(Default)]
struct Sums {
    filter: (f64, f64),
    polished: (f64, f64),
    drives: f64,
}

fn main() {
    let number = |n: usize| std::env::args().nth(n).and_then(|v| v.parse::<u64>().ok());
    let (seeds, particles) = (number(1).unwrap_or(10), number(2).unwrap_or(30) as usize);
    let mut sums = Sums::default();
    for (name, building) in
        [("ladder", Building::ladder()), ("rooms", Building::rooms()), ("blocks", Building::blocks())]
    {
        for seed in 1..=seeds {
            run(&format!("{name} seed {seed}"), &building.drive(seed), (seed, particles), &mut sums);
        }
    }
    let mean = |sum: (f64, f64)| format!("{:.4} m {:.3} deg", sum.0 / sums.drives, sum.1 / sums.drives);
    println!(
        "{} drives: mean error of all relations, filter {}, polished {}; polished over filter {:.3}, of the turns {:.3}",
        sums.drives,
        mean(sums.filter),
        mean(sums.polished),
        sums.polished.0 / sums.filter.0,
        sums.polished.1 / sums.filter.1
    );
}

fn run(name: &str, drive: &Drive, (seed, particles): (u64, usize), sums: &mut Sums) {
    let mut config = ParticleConfig::default();
    config.particles = particles;
    let mut mapper = ParticleMapper::new(config, seed).unwrap();
    let (mut slips, mut bends, mut stamps) = (0, 0, Vec::new());
    for (odom, scan) in drive.odom.iter().zip(&drive.scans) {
        if let ScanUpdate::Processed(done) = mapper.update(*odom, scan) {
            slips += usize::from(done.slipped);
            bends += usize::from(done.loop_correction_m.is_some());
        }
        stamps.push((scan.stamp(), *odom));
    }
    mapper.finish();
    let origin = drive.truth[0].inverse();
    let truth: Vec<(Stamp, Pose2)> =
        stamps.iter().zip(&drive.truth).map(|((stamp, _), truth)| (*stamp, origin * *truth)).collect();
    let known = relations(&truth);
    let compared = |mapper: &ParticleMapper| {
        let found = propagate_trajectory(&mapper.trajectory(), &stamps);
        let errors: Vec<f64> = found.iter().zip(&truth).map(|(f, t)| f.1.distance(&t.1)).collect();
        let worst = errors.iter().copied().fold(0.0, f64::max);
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let agreement = Agreement::of(&known, &truth, &found, None).unwrap();
        (format!("off by {mean:.3} m, at most {worst:.3} m; {agreement}"), agreement)
    };
    let by_odometry = drive.odom.last().unwrap().distance(&truth.last().unwrap().1);
    let (text, filter) = compared(&mapper);
    println!("{name}: {text}; odometry {by_odometry:.1} m off; {slips} slips, {bends} bends");
    let start = Instant::now();
    mapper.polish(&|| true);
    let ms = start.elapsed().as_secs_f64() * 1e3 / mapper.trajectory().len() as f64;
    let (text, polished) = compared(&mapper);
    println!("{name} polished: {text}; {ms:.2} ms a scan");
    sums.filter = (sums.filter.0 + filter.mean(), sums.filter.1 + filter.mean_turn());
    sums.polished = (sums.polished.0 + polished.mean(), sums.polished.1 + polished.mean_turn());
    sums.drives += 1.0;
}

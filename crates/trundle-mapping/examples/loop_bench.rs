//! Loops in drawn buildings, over several seeds: `cargo run --release -p trundle-mapping --example loop_bench -- [SEEDS] [PARTICLES]`
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs, reason = "a measurement for the terminal")]

#[path = "../tests/it/boxes.rs"]
#[allow(dead_code, reason = "the tests use more of it")]
mod boxes;
#[path = "../tests/it/building.rs"]
mod building;
#[path = "carmen_bench/relations.rs"]
#[allow(dead_code, reason = "the benchmark of logs uses more of it")]
mod relations;

use building::Building;
use relations::{Agreement, relations};
use trundle_core::Stamp;
use trundle_mapping::{ParticleConfig, ParticleMapper, ScanUpdate, propagate_trajectory};

fn main() {
    let number = |n: usize| std::env::args().nth(n).and_then(|v| v.parse::<u64>().ok());
    let (seeds, particles) = (number(1).unwrap_or(10), number(2).unwrap_or(30) as usize);
    for (name, building) in
        [("ladder", Building::ladder()), ("rooms", Building::rooms()), ("blocks", Building::blocks())]
    {
        for seed in 1..=seeds {
            let drive = building.drive(seed);
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
            let truth: Vec<_> =
                drive.scans.iter().zip(&drive.truth).map(|(s, t)| (s.stamp(), origin * *t)).collect();
            let known = relations(&truth);
            let agreement = |mapper: &ParticleMapper| {
                let found: Vec<(Stamp, _)> = propagate_trajectory(&mapper.trajectory(), &stamps);
                Agreement::of(&known, &truth, &found, None).unwrap()
            };
            println!("{name} seed {seed} before: {}", agreement(&mapper));
            let start = std::time::Instant::now();
            mapper.polish();
            let took = start.elapsed().as_secs_f64() * 1e3 / mapper.trajectory().len() as f64;
            println!("{name} seed {seed} after:  {}; {took:.1} ms a scan", agreement(&mapper));
            let found: Vec<(Stamp, _)> = propagate_trajectory(&mapper.trajectory(), &stamps);
            let errors: Vec<f64> = found.iter().zip(&truth).map(|(f, t)| f.1.distance(&t.1)).collect();
            let worst = errors.iter().copied().fold(0.0, f64::max);
            let mean = errors.iter().sum::<f64>() / errors.len() as f64;
            let by_odometry = drive.odom.last().unwrap().distance(&(origin * *drive.truth.last().unwrap()));
            println!(
                "{name} seed {seed}: off by {mean:.2} m, at most {worst:.2} m, at the end {:.2} m (odometry {by_odometry:.1} m); {slips} slips, {bends} bends, {:.0} MB",
                errors.last().unwrap(),
                mapper.bytes() as f64 / 1e6
            );
        }
    }
}

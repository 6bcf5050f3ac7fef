//! Quality of the map of a laser log over several seeds: `cargo run --release -p trundle-mapping --example carmen_bench -- LOG [--seeds N]
//! [--particles N] [--laser-x M] [--pgm FILE] [--traj FILE] [--relations FILE] [--but A..B]`. With `--but` it also prints the mean error
//! without relations that touch these poses of the reference.
//!
//! The reference is `--relations FILE` (surveyed relations, lines of `t1 t2 x y z roll pitch yaw`), else `X.ref.traj` (lines of
//! `t x y theta`) beside `X.log`.
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs, reason = "a measurement for the terminal")]

mod log;
mod relations;

use relations::{Agreement, Relation, relations, surveyed};
use trundle_core::{Cell, OccupancyGrid, Pose2, Stamp};
use trundle_mapping::{ParticleConfig, ParticleMapper, ScanUpdate, propagate_trajectory};

/// Time on the processor, ms: others may be at work too.
fn processor_ms() -> f64 {
    // A yield updates the kernel's CPU time, which otherwise advances in ticks of 4 ms.
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    text.split(' ').next().unwrap().parse::<f64>().unwrap() * 1e-6
}

fn option<T: std::str::FromStr>(name: &str) -> Option<T> {
    let mut args = std::env::args().skip_while(|arg| arg != name);
    args.nth(1).map(|value| value.parse().ok().unwrap_or_else(|| panic!("{name} {value}")))
}

struct Run {
    trajectory: Vec<(Stamp, Pose2)>,
    /// The filter's trajectory, before the polish.
    filter: Vec<(Stamp, Pose2)>,
    /// Time of the polish, per processed scan.
    polish_ms: f64,
    scans_ms: Vec<f64>,
    resamplings: usize,
    degenerate: usize,
    bends: usize,
    megabytes: f64,
    grid: OccupancyGrid,
}

fn run(log: &log::Log, config: &ParticleConfig, seed: u64) -> Run {
    let mut mapper = ParticleMapper::new(config.clone(), seed).unwrap();
    let (mut scans_ms, mut resamplings, mut degenerate, mut bends) = (Vec::new(), 0, 0, 0);
    let mut odometry = Vec::new();
    for (i, (odom, scan)) in log.scans.iter().enumerate() {
        let start = processor_ms();
        let update = mapper.update(*odom, scan);
        let ms = processor_ms() - start;
        odometry.push((scan.stamp(), *odom));
        if let ScanUpdate::Processed(p) = update {
            scans_ms.push(ms);
            resamplings += usize::from(p.resampled);
            degenerate += usize::from(p.degenerate > 0);
            bends += usize::from(p.loop_correction_m.is_some());
            if std::env::var("TRACE").is_ok() {
                println!(
                    "{i} {:.2} {:.2} {} {:.1} {} {:?}",
                    p.explained,
                    p.contradicted,
                    p.degenerate,
                    p.effective,
                    p.resampled,
                    mapper.pose()
                );
            }
        }
    }
    mapper.finish();
    let filter = propagate_trajectory(&mapper.trajectory(), &odometry);
    let start = processor_ms();
    mapper.polish(&|| true);
    let polish_ms = (processor_ms() - start) / scans_ms.len() as f64;
    let trajectory = propagate_trajectory(&mapper.trajectory(), &odometry);
    let megabytes = mapper.bytes() as f64 / 1e6;
    let grid = mapper.grid().clone();
    Run { trajectory, filter, polish_ms, scans_ms, resamplings, degenerate, bends, megabytes, grid }
}

fn main() {
    let path = std::env::args().nth(1).expect("a log");
    let laser_x = option("--laser-x").unwrap_or(0.0);
    let log = log::Log::read(&path, laser_x);
    let mut config = ParticleConfig::default();
    config.particles = option("--particles").unwrap_or(30);
    let first: u64 = option("--first").unwrap_or(1);
    let seeds: u64 = option("--seeds").unwrap_or(1);
    let reference = log::read_trajectory(&path.replace(".log", ".ref.traj"));
    let relations: Vec<Relation> = match option::<String>("--relations") {
        Some(file) => surveyed(&std::fs::read_to_string(&file).unwrap()),
        None => reference.as_deref().map(relations).unwrap_or_default(),
    };
    println!("{} scans, {} relations", log.scans.len(), relations.len());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let but = option::<String>("--but").map(|text| {
        let (from, to) = text.split_once("..").expect("--but A..B");
        (from.parse().unwrap(), to.parse().unwrap())
    });
    let mut means = Vec::new();
    for seed in first..first + seeds {
        let mut run = pool.install(|| run(&log, &config, seed));
        run.scans_ms.sort_by(f64::total_cmp);
        let (n, mean) = (run.scans_ms.len(), run.scans_ms.iter().sum::<f64>() / run.scans_ms.len() as f64);
        print!(
            "seed {seed}: {n} processed, median {:.2} mean {mean:.2} 99% {:.2} ms, {:.0} MB, {} resamplings, {} degenerate, {} bends; ",
            run.scans_ms[n / 2],
            run.scans_ms[n * 99 / 100],
            run.megabytes,
            run.resamplings,
            run.degenerate,
            run.bends
        );
        let end = run.trajectory.last().map_or(Pose2::IDENTITY, |(_, pose)| *pose);
        print!("ends at {:.2} {:.2} m {:.1} deg; ", end.x, end.y, end.theta.to_degrees());
        let agreement = |trajectory: &[(Stamp, Pose2)]| {
            Agreement::of(&relations, reference.as_deref().unwrap_or_default(), trajectory, but)
        };
        if let Some(filter) = agreement(&run.filter) {
            print!("filter {filter}; ");
        }
        print!("polished in {:.2} ms a scan; ", run.polish_ms);
        let agreement = agreement(&run.trajectory);
        println!("{}", agreement.as_ref().map_or(String::new(), ToString::to_string));
        means.extend(
            agreement
                .map(|agreement| (agreement.mean(), agreement.open_loops(), seed, agreement.mean_turn())),
        );
        if let Some(pgm) = option::<String>("--pgm") {
            std::fs::write(&pgm, picture(&run.grid)).unwrap();
        }
        if let Some(file) = option::<String>("--traj") {
            let line = |(s, p): &(Stamp, Pose2)| format!("{s} {} {} {}\n", p.x, p.y, p.theta);
            std::fs::write(&file, run.trajectory.iter().map(line).collect::<String>()).unwrap();
        }
    }
    if let Some(worst) = means.iter().max_by(|a, b| a.0.total_cmp(&b.0)) {
        let mean = means.iter().map(|m| m.0).sum::<f64>() / means.len() as f64;
        let turn = means.iter().map(|m| m.3).sum::<f64>() / means.len() as f64;
        let closed = means.iter().filter(|m| m.1 == 0).count();
        println!(
            "{} seeds: mean error of all relations {mean:.3} m on average, {:.3} m in the worst (seed {}), turns {turn:.2} deg; all loops closed in {closed}",
            means.len(),
            worst.0,
            worst.2
        );
    }
}

fn picture(grid: &OccupancyGrid) -> Vec<u8> {
    let g = grid.geometry();
    let mut bytes = format!("P5\n{} {}\n255\n", g.width, g.height).into_bytes();
    for row in grid.cells().chunks(g.width).rev() {
        bytes.extend(row.iter().map(|cell| match cell {
            Cell::Free => 254,
            Cell::Occupied => 0,
            Cell::Unknown => 205_u8,
        }));
    }
    bytes
}

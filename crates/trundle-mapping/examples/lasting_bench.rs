//! Cost of the filter over a long time in one place: `cargo run --release -p trundle-mapping --example lasting_bench [SCANS]
//! [--particles N] [--log FILE]`
//!
//! A robot circles in a furnished room of 10 x 8 m; each scan is processed. With `--log` the drive is written as a CARMEN log instead, for
//! `bench/mapping/long_logs.py`. Prints processor time (with that of the simulated laser) and memory by tenths of the drive, and
//! the slopes between the first and the last half.
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs, reason = "a measurement for the terminal")]

#[path = "../tests/it/flat_room.rs"]
#[allow(dead_code, reason = "the tests use more of it")]
mod flat_room;

use flat_room::FlatRoom;
use std::f64::consts::TAU;
use std::io::Write;
use trundle_core::{Beam, Pose2, Scan, ScanParts, Stamp};
use trundle_mapping::{ParticleConfig, ParticleMapper};

const BEAMS: usize = 360;
const MAX_RANGE_M: f64 = 12.0;
/// Path between two scans \[m\]: a little more than the filter's gate. Source: ours.
const STEP_M: f64 = 0.31;

fn room() -> FlatRoom {
    FlatRoom::new(&[
        &[(-5.0, -4.0), (5.0, -4.0), (5.0, 4.0), (-5.0, 4.0)],
        &[(-1.0, -0.5), (1.2, -0.5), (1.2, 0.6), (-1.0, 0.6)],
        &[(3.5, 2.9), (4.9, 2.9), (4.9, 3.9), (3.5, 3.9)],
        &[(-4.6, -3.0), (-4.0, -3.0), (-4.0, -1.0), (-4.6, -1.0)],
    ])
}

/// Poses around the room's middle, on ellipses that change slowly.
fn poses() -> impl Iterator<Item = Pose2> {
    let mut angle = 0.0_f64;
    (0..).map(move |k| {
        let radius = 2.4 + 0.4 * (f64::from(k) * STEP_M / 97.0).sin();
        angle += STEP_M / radius;
        Pose2::new(1.2 * radius * angle.cos(), radius * angle.sin(), angle + TAU / 4.0)
    })
}

/// About normal, sigma 1.
fn noise(seed: u64) -> f64 {
    let mut bits = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678;
    let sum: f64 = (0..6)
        .map(|_| {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            (bits >> 11) as f64 / 2_f64.powi(53) - 0.5
        })
        .sum();
    sum * 2_f64.sqrt()
}

fn resident_mb() -> f64 {
    let text = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    text.split(' ').nth(1).and_then(|pages| pages.parse::<f64>().ok()).unwrap_or(f64::NAN) * 4096e-6
}

/// Processor time of all threads \[s\]: others may be at work too.
fn processor_s() -> f64 {
    const TICKS_PER_SECOND: f64 = 100.0;
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = text.rsplit(") ").next().unwrap_or_default().split(' ').collect();
    let ticks = |k: usize| fields.get(k).and_then(|field| field.parse::<f64>().ok()).unwrap_or(f64::NAN);
    (ticks(11) + ticks(12)) / TICKS_PER_SECOND
}

/// A step of the drive: true pose, odometry and scan.
type Step = (Pose2, Pose2, Scan);

fn drive(scans: usize) -> impl Iterator<Item = Step> {
    let (room, mut odom, mut last) = (room(), Pose2::IDENTITY, None);
    poses().take(scans).enumerate().map(move |(k, at)| {
        if let Some(last) = last.replace(at) {
            let seed = 3 * k as u64;
            let slip =
                Pose2::new(0.006 * noise(seed), 0.003 * noise(seed + 1), 0.004 * noise(seed + 2) + 0.001);
            odom = odom * (last.inverse() * at) * slip;
        }
        let seen = room.scan(at, TAU, BEAMS, MAX_RANGE_M, |i| 0.01 * noise((k * BEAMS + i) as u64));
        let parts = ScanParts { beams: seen.beams().to_vec(), ..ScanParts::default() };
        let stamp = Stamp::from_secs(k as f64).unwrap();
        let scan = Scan::from_parts(stamp, seen.origin(), (seen.angle_min(), seen.angle_increment()), parts);
        (at, odom, scan.unwrap())
    })
}

/// Number of beams of which one has no return in the log. Source: ours.
const BEAMS_PER_MISS: usize = 97;

/// Writes the drive as a CARMEN log with the field of view of a whole turn.
fn write_log(file: &str, scans: usize) -> std::io::Result<()> {
    let mut file = std::io::BufWriter::new(std::fs::File::create(file)?);
    writeln!(file, "PARAM laser_front_laser_fov 360 nohost 0")?;
    for (k, (_, odom, scan)) in drive(scans).enumerate() {
        write!(file, "FLASER {BEAMS}")?;
        for (i, beam) in scan.beams().iter().enumerate() {
            match beam {
                Beam::Hit { range } if (7 * k + i) % BEAMS_PER_MISS != 0 => write!(file, " {range:.3}")?,
                _ => write!(file, " {MAX_RANGE_M:.3}")?,
            }
        }
        let Pose2 { x, y, theta } = odom;
        let pose = format!("{x:.6} {y:.6} {theta:.6}");
        writeln!(file, " {pose} {pose} {} nohost {}", scan.stamp(), scan.stamp())?;
    }
    file.flush()
}

fn option(name: &str) -> Option<String> {
    std::env::args().skip_while(|arg| arg != name).nth(1)
}

fn main() {
    let scans: usize = std::env::args().nth(1).map_or(10_000, |count| count.parse().unwrap());
    if let Some(file) = option("--log") {
        return write_log(&file, scans).unwrap();
    }
    let mut config = ParticleConfig::default();
    config.particles = option("--particles").map_or(config.particles, |count| count.parse().unwrap());
    let mut mapper = ParticleMapper::new(config, 1).unwrap();
    let (tenth, mut rows) = ((scans / 10).max(1), Vec::new());
    let (mut first, mut last) = (None, Pose2::IDENTITY);
    for (k, (at, odom, scan)) in drive(scans).enumerate() {
        last = first.get_or_insert(at).inverse() * at;
        mapper.update(odom, &scan);
        if (k + 1) % tenth == 0 {
            let spent = processor_s();
            rows.push((spent, mapper.bytes() as f64 / 1e6));
            let (ms, mb) = (spent / (k + 1) as f64 * 1e3, mapper.bytes() as f64 / 1e6);
            println!(
                "{:>8} scans: {ms:.3} ms a scan, filter {mb:.1} MB, process {:.1} MB",
                k + 1,
                resident_mb()
            );
        }
    }
    println!("end: {:.3} m off", mapper.pose().distance(&last));
    println!("poses of the trajectory: {}", mapper.trajectory().len());
    let half = rows.len() / 2;
    let (middle, end) = (rows[half - 1], rows[rows.len() - 1]);
    println!("time of the second half by that of the first: {:.2}", (end.0 - middle.0) / middle.0);
    println!("memory at the end by that at the half: {:.2}", end.1 / middle.1);
    println!("time for a scan: {:.3} ms", end.0 / scans as f64 * 1e3);
}

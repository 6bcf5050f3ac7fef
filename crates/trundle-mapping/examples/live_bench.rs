//! A live map over one hour at 5 Hz, and a loop closure that bends the whole map: `cargo run --release -p trundle-mapping --example
//! live_bench`
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs, reason = "a measurement for the terminal")]

#[path = "../tests/it/boxes.rs"]
#[allow(dead_code, reason = "the tests use more of it")]
mod boxes;
#[path = "../tests/it/building.rs"]
#[allow(dead_code, reason = "the tests use more of it")]
mod building;

use building::Building;
use trundle_core::{Pose2, Scan, ScanParts, Stamp};
use trundle_mapping::{LiveMapper, MapperConfig};

const HERTZ: f64 = 5.0;
const SCANS: usize = 18_000;
/// Minimum number of cells redrawn per control step. Source: `trundle-runtime`.
const MIN_REDRAWN_CELLS: usize = 60_000;
/// Number of control steps for the whole map. Source: `trundle-runtime`.
const REDRAWING_STEPS: usize = 90;

/// Time on the processor, ms: others may be at work too.
fn processor_ms() -> f64 {
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    text.split(' ').next().unwrap().parse::<f64>().unwrap() * 1e-6
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = processor_ms();
    let result = work();
    (processor_ms() - start, result)
}

fn report(name: &str, mut times: Vec<f64>) {
    times.sort_by(f64::total_cmp);
    let at = |part: f64| times[((times.len() - 1) as f64 * part) as usize];
    println!("{name}: median {:.2} ms, 99 % {:.2} ms, at most {:.2} ms", at(0.5), at(0.99), at(1.0));
}

fn main() {
    let drive = Building::rooms().drive(1);
    let mut config = MapperConfig::default();
    config.blind_range = 0.0;
    let mut mapper = LiveMapper::new(config).unwrap();
    let (mut inserts, mut shown) = (Vec::new(), Vec::new());
    // Forth and back for one hour.
    let forth = drive.scans.len();
    for k in 0..SCANS {
        let lap = k % (2 * forth);
        let i = if lap < forth { lap } else { 2 * forth - 1 - lap };
        let stamp = Stamp::from_secs(k as f64 / HERTZ).unwrap();
        let old = &drive.scans[i];
        let parts = ScanParts { beams: old.beams().to_vec(), ..ScanParts::default() };
        let scan =
            Scan::from_parts(stamp, old.origin(), (old.angle_min(), old.angle_increment()), parts).unwrap();
        inserts.push(timed(|| mapper.insert(drive.truth[i], &scan)).0);
        let before = mapper.revision();
        shown.push(timed(|| mapper.changes_since(before.saturating_sub(1)).count()).0);
    }
    println!(
        "{SCANS} scans over {:.0} min, {} things kept",
        SCANS as f64 / HERTZ / 60.0,
        mapper.logged_entries()
    );
    report("drawing a scan", inserts);
    report("telling what changed", shown);
    let end = SCANS as f64 / HERTZ;
    let bend = |stamp: Stamp, pose: Pose2| {
        Pose2::exp(nalgebra::Vector3::new(0.3, 0.1, 0.02) * (stamp.as_secs() / end)) * pose
    };
    let (correct, moved) = timed(|| mapper.correct(bend));
    let mut slices = Vec::new();
    while mapper.is_redrawing() {
        let within = REDRAWING_STEPS.saturating_sub(slices.len()).max(1);
        slices.push(timed(|| mapper.work_within(MIN_REDRAWN_CELLS, within)).0);
    }
    let all: f64 = slices.iter().sum();
    println!(
        "a loop moves {moved} of them in {correct:.1} ms; redrawn in {all:.0} ms of processor time, {} slices",
        slices.len()
    );
    println!("at 50 slices per second that is {:.1} s", slices.len() as f64 / 50.0);
    report("a slice", slices);
}

//! First places in known maps: three small lasers, random starts on each map.
//!
//! `cargo run --release -p trundle-experiments --example first_place -- ../shared/data/nav [STARTS] [MAP]`
//! prints, for each map and laser, the number of starts at which the first place result as known was right and wrong, and the time to it.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::unwrap_used,
    reason = "a measurement for the terminal"
)]

use rayon::prelude::*;
use std::path::{Path, PathBuf};
use trundle_app::AppError;
use trundle_core::{OccupancyGrid, Pose2};
use trundle_experiments::laser_drive::{drive, random_start, world_of};
use trundle_io::read_map;
use trundle_mapping::{Localized, MapLocalizer, ParticleConfig};
use trundle_sim::LaserConfig;

/// Maps of the folder.
const MAPS: [&str; 6] = [
    "nav2/tb3_sandbox.yaml",
    "nav2/depot.yaml",
    "mrpb/maps/office01add/map.yaml",
    "mrpb/maps/office02_partially_unknown/map.yaml",
    "mrpb/maps/room02/map.yaml",
    "mrpb/maps/track/map.yaml",
];
/// Duration of a drive \[s\]. Source: ours.
const DRIVE_S: f64 = 60.0;
/// Distance from the truth beyond which a pose is wrong \[m\]. Source: ours.
const MAX_DISTANCE_M: f64 = 0.5;
/// Turn from the truth beyond which a pose is wrong \[rad\]: 15 deg. Source: ours.
const MAX_TURN_RAD: f64 = 0.26;

/// What was result of one drive.
#[derive(Debug, Clone, Copy, Default)]
struct DriveResult {
    /// Time of the first known place, s.
    first_s: Option<f64>,
    is_first_wrong: bool,
    known: usize,
    wrong: usize,
}

fn main() -> Result<(), AppError> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = PathBuf::from(arguments.first().map_or("../shared/data/nav", String::as_str));
    let starts = arguments.get(1).and_then(|count| count.parse().ok()).unwrap_or(50_u64);
    let only = arguments.get(2).map_or("", String::as_str);
    let mut sums = (0, 0, 0);
    for map in MAPS.iter().filter(|map| map.contains(only)) {
        let grid = read_map(&folder.join(map))?;
        for (name, _, laser) in LaserConfig::PRESETS.iter().filter(|(name, ..)| *name != "ust-10lx") {
            let result: Result<Vec<DriveResult>, AppError> = (0..starts)
                .into_par_iter()
                .map(|seed| localize_drive(Path::new(map), &grid, laser(), seed))
                .collect();
            let result = result?;
            let mut times: Vec<f64> = result.iter().filter_map(|result| result.first_s).collect();
            times.sort_by(f64::total_cmp);
            let first_wrong = result.iter().filter(|result| result.is_first_wrong).count();
            let (known, wrong) = result.iter().fold((0, 0), |sum, t| (sum.0 + t.known, sum.1 + t.wrong));
            let median = times.get(times.len() / 2).copied().unwrap_or(f64::NAN);
            println!(
                "{map} {name}: found {} of {starts}, first place wrong {first_wrong}, scans wrong {wrong} of {known}, median {median:.1} s",
                times.len()
            );
            sums = (sums.0 + times.len(), sums.1 + first_wrong, sums.2 + wrong);
        }
    }
    println!("all: found {}, first place wrong {}, scans wrong {}", sums.0, sums.1, sums.2);
    Ok(())
}

/// Localizes one drive in the map of its walls.
fn localize_drive(
    name: &Path,
    grid: &OccupancyGrid,
    laser: LaserConfig,
    seed: u64,
) -> Result<DriveResult, AppError> {
    let world = world_of(&name.display().to_string(), grid)?;
    let start = random_start(grid, &world, seed)?;
    let drive = drive(world, (laser, start), DRIVE_S, seed)?;
    let mut config = ParticleConfig::default();
    config.map = config.map.with_resolution(grid.geometry().resolution);
    let mut localizer = MapLocalizer::from_grid(grid, config, seed)?;
    let mut result = DriveResult::default();
    for scan in &drive.scans {
        let reported = localizer.update(scan.odom_from_base, &scan.scan);
        let Localized::Known { map_from_base, .. } = reported else { continue };
        let wrong = is_wrong(map_from_base, scan.world_from_base);
        if result.first_s.is_none() {
            result.first_s = Some(scan.scan.stamp().as_secs());
            result.is_first_wrong = wrong;
            if wrong {
                eprintln!(
                    "seed {seed}: {map_from_base:?} for {:?} at {:?}",
                    scan.world_from_base, result.first_s
                );
            }
        }
        result.known += 1;
        result.wrong += usize::from(wrong);
    }
    Ok(result)
}

fn is_wrong(result: Pose2, truth: Pose2) -> bool {
    let off = truth.inverse() * result;
    off.position().norm() > MAX_DISTANCE_M || off.theta.abs() > MAX_TURN_RAD
}

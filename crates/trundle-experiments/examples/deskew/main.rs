//! Maps of simulated drives by lasers of 5, 5.5, 10 and 40 Hz, with and without deskewing.
//!
//! `cargo run --release -p trundle-experiments --example deskew -- ../shared/data/nav [SEEDS]` prints, for each laser and map, the error of
//! the trajectory after alignment by mean place and mean heading, and of the heading, over all seeds.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a measurement for the terminal")]

use std::path::PathBuf;
use trundle_app::AppError;
use trundle_core::{OccupancyGrid, Pose2, Vector2, wrap_angle};
use trundle_experiments::laser_drive::{LaserDrive, drive, random_start, world_of};
use trundle_io::read_map;
use trundle_mapping::{ParticleConfig, ParticleMapper};
use trundle_sim::LaserConfig;

/// Maps of the folder.
const MAPS: [&str; 3] =
    ["nav2/tb3_sandbox.yaml", "mrpb/maps/office01add/map.yaml", "mrpb/maps/room02/map.yaml"];
/// Duration of a drive \[s\]. Source: ours.
const DRIVE_S: f64 = 120.0;

/// Error of a trajectory: mean and largest position \[m\], mean and largest heading \[deg\].
type Error = [f64; 4];

fn main() -> Result<(), AppError> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = PathBuf::from(arguments.first().map_or("../shared/data/nav", String::as_str));
    let seeds = arguments.get(1).and_then(|count| count.parse().ok()).unwrap_or(5_u64);
    for (name, _, laser) in LaserConfig::PRESETS {
        let mut sums = [[0.0; 4]; 2];
        for map in MAPS {
            let grid = read_map(&folder.join(map))?;
            for seed in 1..=seeds {
                let world = world_of(map, &grid)?;
                let start = random_start(&grid, &world, seed)?;
                let swept = drive(world, (laser(), start), DRIVE_S, seed)?;
                for (sum, drive) in sums.iter_mut().zip([swept.clone(), swept.deskewed()]) {
                    let error = error(&drive, &grid, seed)?;
                    sum.iter_mut().zip(error).for_each(|(sum, error)| *sum += error);
                }
            }
        }
        let count = (seeds * MAPS.len() as u64) as f64;
        for (what, sum) in ["as measured", "deskewed"].iter().zip(sums) {
            let [mean, max_distance, turn, max_turn] = sum.map(|sum| sum / count);
            println!(
                "{name} {what}: mean {:.2} cm, largest {:.2} cm, heading mean {turn:.3} deg, largest {max_turn:.3} deg",
                100.0 * mean,
                100.0 * max_distance
            );
        }
    }
    Ok(())
}

/// Error of the trajectory of a mapped drive.
fn error(drive: &LaserDrive, grid: &OccupancyGrid, seed: u64) -> Result<Error, AppError> {
    let mut config = ParticleConfig::default();
    config.map = config.map.with_resolution(grid.geometry().resolution);
    let mut mapper = ParticleMapper::new(config, seed)?;
    for entry in &drive.scans {
        mapper.update(entry.odom_from_base, &entry.scan);
    }
    mapper.finish();
    let mut truth = drive.scans.iter();
    let pairs: Vec<(Pose2, Pose2)> = mapper
        .trajectory()
        .into_iter()
        .filter_map(|(stamp, pose)| {
            let entry = truth.find(|entry| entry.scan.stamp() == stamp)?;
            Some((pose, entry.world_from_base))
        })
        .collect();
    Ok(aligned_error(&pairs))
}

/// Error after the rigid motion with the mean turn and the mean place.
fn aligned_error(pairs: &[(Pose2, Pose2)]) -> Error {
    let count = pairs.len().max(1) as f64;
    let mean = |pick: fn(&(Pose2, Pose2)) -> Vector2| pairs.iter().map(pick).sum::<Vector2>() / count;
    let (from, to) = (mean(|pair| pair.0.position()), mean(|pair| pair.1.position()));
    let turns = pairs.iter().map(|(map, world)| (world.theta - map.theta).sin_cos());
    let (sin, cos) = turns.fold((0.0, 0.0), |sum, turn| (sum.0 + turn.0, sum.1 + turn.1));
    let turn = Pose2::new(0.0, 0.0, sin.atan2(cos));
    let mut error = [0.0_f64; 4];
    for (map, world) in pairs {
        let off = (turn.rotate(map.position() - from) + to - world.position()).norm();
        let heading = wrap_angle(map.theta + turn.theta - world.theta).abs().to_degrees();
        error[0] += off / count;
        error[1] = error[1].max(off);
        error[2] += heading / count;
        error[3] = error[3].max(heading);
    }
    error
}

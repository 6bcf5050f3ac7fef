//! The map of 2-D laser scans with raw odometry, by a Rao-Blackwellised particle filter.
//!
//! `cargo run --release --example 02_map_a_laser_log -- LOG`; without a log, a simulated drive with an RPLIDAR.

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use std::path::Path;
use trundle::core::{Pose2, RobotBody, Scan, SensorEvent, Twist2};
use trundle::io::{LaserLogOptions, read_laser_log};
use trundle::mapping::{ParticleConfig, ParticleMapper};
use trundle::sim::{LaserConfig, Scene, SimConfig, Simulator};

/// Maps the scans and prints the area of the known floor.
///
/// # Errors
/// When the log cannot be read.
pub fn main() -> Result<(), Box<dyn Error>> {
    let argument = std::env::args().nth(1).filter(|argument| Path::new(argument).is_file());
    let scans = match argument {
        Some(log) => {
            let log = read_laser_log(Path::new(&log), &LaserLogOptions::default())?;
            log.scans.into_iter().map(|entry| (entry.odom_from_base, entry.scan)).collect()
        }
        None => simulated_scans()?,
    };
    let mut mapper = ParticleMapper::new(ParticleConfig::default(), 1)?;
    for (odom_from_base, scan) in &scans {
        mapper.update(*odom_from_base, scan);
    }
    let pose = mapper.pose();
    println!(
        "{} scans; the robot ends at ({:.2}, {:.2}) m, {:.1} deg",
        scans.len(),
        pose.x,
        pose.y,
        pose.theta.to_degrees()
    );
    let occupied =
        mapper.grid().cells().iter().filter(|cell| **cell == trundle::core::Cell::Occupied).count();
    println!("{occupied} occupied cells");
    assert!(occupied > 0, "walls are in the map");
    Ok(())
}

/// Two seconds of driving with a laser: raw odometry is the true pose here.
fn simulated_scans() -> Result<Vec<(Pose2, Scan)>, Box<dyn Error>> {
    let mut config = SimConfig::default();
    config.laser = Some(LaserConfig::rplidar_a1());
    let mut body = Simulator::new(Scene::by_name("room", 1)?, config, 1)?;
    body.command(Twist2::new(0.2, 0.1))?;
    let (mut pose, mut scans) = (Pose2::IDENTITY, Vec::new());
    while let Some(event) = body.next_event()? {
        match event {
            SensorEvent::Truth { pose: world_from_base, .. } => pose = world_from_base,
            SensorEvent::Scan(scan) => scans.push((pose, scan)),
            _ => {}
        }
        if scans.len() == 10 {
            break;
        }
    }
    Ok(scans)
}

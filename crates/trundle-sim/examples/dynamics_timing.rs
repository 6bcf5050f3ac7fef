//! Simulated seconds per wall-clock second, without camera.
//!
//! `cargo run --release -p trundle-sim --example dynamics_timing [SCENE...]`: built-in scenes or glTF files, z up.
#![allow(clippy::print_stdout, reason = "an example talks to its user")]

use std::time::Instant;
use trundle_core::{Footprint, Pose2, RobotBody, SensorEvent, Twist2};
use trundle_sim::import::{GltfOptions, gltf};
use trundle_sim::{HeightBand, LaserConfig, Scene, SimConfig, Simulator, World};

/// Seconds of the robot's time a run. Source: ours.
const SPAN: f64 = 60.0;

/// Runs of which the median counts. Source: ours.
const RUNS: u64 = 5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let names = if names.is_empty() { vec!["demo".to_owned(), "obstacles".to_owned()] } else { names };
    for name in names {
        for laser in [None, Some(LaserConfig::rplidar_a1())] {
            let what = if laser.is_some() { "with an RPLIDAR A1" } else { "base alone" };
            let mut speeds = Vec::new();
            let mut contacts = 0;
            for seed in 0..RUNS {
                let scene = scene(&name)?;
                let mut config = SimConfig::default();
                config.has_camera = false;
                config.laser = laser.clone();
                let mut robot = Simulator::new(scene, config, seed)?;
                let start = Instant::now();
                wander(&mut robot)?;
                speeds.push(SPAN / start.elapsed().as_secs_f64());
                contacts += robot.contacts();
            }
            speeds.sort_by(f64::total_cmp);
            let median = speeds[speeds.len() / 2];
            println!("{name}, {what}: {median:.0} x real time ({contacts} contacts in {RUNS} minutes)");
        }
    }
    Ok(())
}

/// A built-in scene, or a file with the robot in the first free place of a coarse grid.
fn scene(name: &str) -> Result<Scene, Box<dyn std::error::Error>> {
    if !name.ends_with(".glb") {
        return Ok(Scene::by_name(name, 1)?);
    }
    let world = World::with_meshes(Vec::new(), vec![gltf(name.as_ref(), &GltfOptions::z_up())?.mesh], 1)?;
    let obstacles = world.obstacles(HeightBand::new(0.012, 0.6)?);
    let (low, _) = world.bounds();
    let place = |i: u32| Pose2::new(low.x + f64::from(i % 100) * 0.3, low.y + f64::from(i / 100) * 0.3, 0.0);
    let is_free = |place: &Pose2| obstacles.clearance(&Footprint::KOBUKI, *place) > 0.3;
    let start = (1500..10_000).map(place).find(is_free).ok_or("no free place")?;
    Ok(Scene { name: name.into(), world, start, ..Scene::by_name("room", 1)? })
}

/// Drives at random; after a contact, backs off and turns.
fn wander(robot: &mut Simulator) -> Result<(), Box<dyn std::error::Error>> {
    let mut until_free = 0.0;
    robot.command(Twist2::new(0.4, 0.1))?;
    while robot.stamp().as_secs() < SPAN {
        match robot.next_event()? {
            Some(SensorEvent::Touch(touch)) if touch.pressed => {
                until_free = touch.stamp.as_secs() + 1.5;
                robot.command(Twist2::new(-0.2, 0.9))?;
            }
            Some(SensorEvent::Wheels(wheels)) if until_free > 0.0 && wheels.stamp.as_secs() > until_free => {
                until_free = 0.0;
                robot.command(Twist2::new(0.4, 0.1))?;
            }
            _ => {}
        }
    }
    Ok(())
}

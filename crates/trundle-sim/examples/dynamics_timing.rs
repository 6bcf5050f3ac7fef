//! How many seconds of the robot's time a second of the clock simulates, without camera.
//!
//! `cargo run --release -p trundle-sim --example dynamics_timing [SCENE...]`: built-in scenes or scene files.
#![allow(clippy::print_stdout, reason = "an example talks to its user")]

use std::time::Instant;
use trundle_core::{RobotBody, SensorEvent, Twist2};
use trundle_sim::{LaserConfig, Scene, SimConfig, Simulator};

/// Seconds of the robot's time a run.
const SPAN: f64 = 60.0;

/// Runs of which the median counts.
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
                let scene = Scene::by_name(&name, 1)?;
                let config = SimConfig { has_camera: false, laser: laser.clone(), ..SimConfig::default() };
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

/// Drives about, and back and aside when it touches something.
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

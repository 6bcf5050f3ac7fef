//! The whole robot in the simulator: sensor events in, twists out.
//!
//! `cargo run --release --example 05_drive_in_the_simulator`

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use trundle::core::{Pose2, RobotBody};
use trundle::runtime::{Robot, RobotConfig};
use trundle::sim::{Scene, SimConfig, Simulator};

/// Time of the simulation after which the example stops the drive \[s\]. Source: ours.
const TIME_LIMIT_S: f64 = 30.0;

/// Drives half a metre forward and prints how the drive ended.
///
/// # Errors
/// When the scene or the robot is not valid.
pub fn main() -> Result<(), Box<dyn Error>> {
    let mut body = Simulator::new(Scene::by_name("demo", 1)?, SimConfig::default(), 1)?;
    let mut robot = Robot::new(RobotConfig::default())?;
    robot.drive_to(Pose2::new(0.5, 0.0, 0.0))?;
    while let Some(event) = body.next_event()? {
        let report = robot.step(&event);
        if let Some(twist) = report.twist {
            body.command(twist)?;
        }
        if report.finished {
            println!("finished after {} s with {} contacts", event.stamp(), body.contacts());
            assert_eq!(body.contacts(), 0);
            return Ok(());
        }
        if event.stamp().as_secs() > TIME_LIMIT_S {
            return Err("the goal was not reached in time".into());
        }
    }
    Ok(())
}

//! Exploration: the robot drives to frontiers between free and unknown floor until no frontier is left.
//!
//! `cargo run --release --example 06_explore -- SECONDS`; without an argument, three seconds.

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use trundle::core::RobotBody;
use trundle::runtime::{Mission, Robot, RobotConfig, Task};
use trundle::sim::{Scene, SimConfig, Simulator};

/// Explores for a fixed time and prints the state of the mission each second.
///
/// # Errors
/// When the scene or the robot is not valid.
pub fn main() -> Result<(), Box<dyn Error>> {
    let seconds: f64 = std::env::args().nth(1).and_then(|argument| argument.parse().ok()).unwrap_or(3.0);
    let mut body = Simulator::new(Scene::by_name("demo", 1)?, SimConfig::default(), 1)?;
    let mut robot = Robot::new(RobotConfig::default())?;
    robot.begin(&Mission::new(vec![Task::Explore, Task::Return])?);
    let mut images = 0;
    while let Some(event) = body.next_event()? {
        let report = robot.step(&event);
        if let Some(twist) = report.twist {
            body.command(twist)?;
        }
        images += usize::from(matches!(event, trundle::core::SensorEvent::Rgbd(_)));
        if report.finished || event.stamp().as_secs() > seconds {
            break;
        }
    }
    println!("{images} images; the task is {:?}, {} ended", robot.task(), robot.tasks_ended().len());
    assert!(images > 0);
    Ok(())
}

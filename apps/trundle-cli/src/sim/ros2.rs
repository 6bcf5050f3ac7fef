//! The simulator as a ROS 2 robot.

use super::SimArgs;
use crate::console;
use crate::outcome::Outcome;
use trundle::app::{AppError, stop};
use trundle::core::DifferentialDrive;
use trundle::experiments::simulated::load_simulator;
use trundle::ros2::server::{OfferedBody, serve_body};

/// Publishes the robot's sensors and follows `cmd_vel` until the time is over or the user interrupts.
pub fn serve(args: &SimArgs, name: &str) -> Result<Outcome, AppError> {
    let (options, config) = (args.ros_robot.ros.options()?, args.sensors.config()?);
    let (camera, base_from_camera) = (config.camera, config.base_from_camera);
    let offered = OfferedBody { camera, base_from_camera, drive: DifferentialDrive::KOBUKI };
    let mut simulator = load_simulator(name, args.place.options(), config)?;
    if !args.common.quiet {
        console::print(&options.node.robot_greeting(name));
    }
    let limit = args.driver.duration.unwrap_or(f64::INFINITY);
    serve_body(&options, args.ros_robot.raw_images, offered, &mut simulator, |time| {
        let time = time.as_secs();
        time >= limit || stop::is_requested(|| format!("{time:.1} s of the robot's time"))
    })?;
    Ok(Outcome::Reached)
}

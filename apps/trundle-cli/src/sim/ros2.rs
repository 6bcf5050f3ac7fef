//! The simulator as a ROS 2 robot.

use super::SimArgs;
use crate::console;
use crate::outcome::Outcome;
use crate::ros2::refused;
use trundle::app::{AppError, stop};
use trundle::core::DifferentialDrive;
use trundle::experiments::simulated::load_scene;
use trundle::ros2::node::RosNode;
use trundle::ros2::server::{BodyServer, OfferedBody, ServerSettings};
use trundle::sim::Simulator;

/// Publishes the robot's sensors and obeys `cmd_vel` until the time is over or the user interrupts.
pub fn serve(args: &SimArgs, name: &str) -> Result<Outcome, AppError> {
    let options = args.ros.options()?;
    let config = args.sensors.config()?;
    let offered = OfferedBody {
        camera: config.camera,
        base_from_camera: config.base_from_camera,
        drive: DifferentialDrive::KOBUKI,
    };
    let scene = load_scene(name, args.scene_options())?;
    let mut simulator = Simulator::new(scene, config, args.seed)
        .map_err(|error| AppError::Input(format!("{name}: {error}")))?;
    let settings = ServerSettings {
        frames: options.frames.clone(),
        stamped_commands: options.stamped_commands,
        raw_images: args.raw_images,
    };
    let mut node = RosNode::new(&options.node).map_err(refused)?;
    let mut server = BodyServer::new(&mut node, settings, offered).map_err(refused)?;
    let node = node.start().map_err(refused)?;
    if !args.common.quiet {
        let domain = options.node.domain;
        console::print(&format!(
            "A robot in '{name}' answers on ROS 2 domain {domain}. Drive it: trundle ros2 --ros-args -p use_sim_time:=true"
        ));
    }
    let limit = args.duration.unwrap_or(f64::INFINITY);
    let is_over = |time: trundle::core::Stamp| {
        let time = time.as_secs();
        time >= limit || stop::is_requested(|| format!("{time:.1} s of the robot's time"))
    };
    let run = server.run(&mut simulator, is_over);
    drop(node);
    run.map_err(|error| AppError::Input(error.to_string()))?;
    Ok(Outcome::Reached)
}

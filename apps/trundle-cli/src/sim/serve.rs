//! The simulator behind the wires of a real robot.

use super::SimArgs;
use crate::console;
use crate::outcome::Outcome;
use std::path::Path;
use trundle::app::{AppError, stop};
use trundle::experiments::simulated::{EmulatedRobot, load_simulator};

/// Serves base and camera until the time is over or the user interrupts; prints the robot's true pose.
pub fn serve(args: &SimArgs, name: &str, port: &Path) -> Result<Outcome, AppError> {
    let simulator = load_simulator(name, args.place.options(), args.sensors.config()?)?;
    let mut robot = EmulatedRobot::at(simulator, port, args.wires.camera_stream.as_deref())?;
    if !args.common.quiet {
        console::print(&greeting(args, port));
    }
    let limit = args.driver.duration.unwrap_or(f64::INFINITY);
    robot.run(|simulator| {
        let time = simulator.stamp().as_secs();
        time >= limit || stop::is_requested(|| format!("{time:.1} s of the robot's time"))
    })?;
    if !args.common.quiet {
        console::print_table(&robot.rows());
    }
    Ok(Outcome::Reached)
}

fn greeting(args: &SimArgs, port: &Path) -> String {
    let port = port.display();
    let camera = args.wires.camera_stream.as_ref().map(|path| format!(" --camera stream:{}", path.display()));
    format!(
        "A Kobuki answers at {port}. Drive it: trundle run --base kobuki:{port}{}",
        camera.unwrap_or_default()
    )
}

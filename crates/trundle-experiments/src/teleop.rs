//! The page for driving by hand: image, depth, map and state of the simulated robot, served to browsers on the same machine.

mod page;
mod server;
mod steering;

pub use page::{RobotView, TeleopPage};
pub use server::TeleopServer;
pub use steering::{Steering, SteeringKey};

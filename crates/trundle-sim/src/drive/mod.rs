//! Drives of a simulated robot without autonomy: timed commands, and way-points by the true pose.

mod follower;
mod follower_config;
mod rows;
mod script;

pub use follower::{Following, WaypointFollower};
pub use follower_config::WaypointFollowerConfig;
pub use script::{CommandScript, TimedCommand};

//! ROS 2 for trundle: a ROS 2 robot as a body, the robot as a ROS 2 node, a body offered as a ROS 2 robot.

pub mod body;
pub mod clock;
pub mod convert;
mod error;
#[rustfmt::skip]
pub mod generated;
pub mod interface;
pub mod navigation;
pub mod node;
pub mod outputs;
pub mod server;
pub mod wire;

pub use error::Ros2Error;

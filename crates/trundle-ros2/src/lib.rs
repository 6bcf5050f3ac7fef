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
mod options;
pub mod outputs;
mod robot_node;
pub mod server;
pub mod wire;

pub use error::Ros2Error;
pub use options::Ros2Options;
pub use robot_node::{BodyStart, RobotNode, Ros2Robot};

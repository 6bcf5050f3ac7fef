//! ROS 2 for trundle: a ROS 2 robot as a body, the robot as a ROS 2 node, a body offered as a ROS 2 robot.
//!
//! ```
//! use trundle_core::Pose2;
//! use trundle_ros2::convert::pose;
//! let map_from_base = Pose2::new(1.0, 2.0, 0.5);
//! let read = pose::pose2(&pose::to_ros(&map_from_base))?;
//! assert!(read.distance(&map_from_base) < 1e-12);
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

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
mod twist_topic;
pub mod wire;

pub use error::Ros2Error;
pub use options::Ros2Options;
pub use robot_node::{BodyStart, RobotNode, Ros2Robot};

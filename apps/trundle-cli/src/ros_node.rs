//! ROS 2 options of several commands, and the node of `trundle run`.

use crate::console;
use clap::Args;
use std::time::Instant;
use trundle::app::AppError;
use trundle::app::operator::OperatorLink;
use trundle::app::real_time::EventObserver;
use trundle::ros2::node::Networks;
use trundle::ros2::{RobotNode, Ros2Options};
use trundle::runtime::RobotConfig;

/// Network and names of a ROS 2 node.
#[derive(Debug, Args)]
pub struct RosArgs {
    /// Domain: nodes of different domains do not communicate [default: ROS_DOMAIN_ID, else 0]
    #[arg(long, value_name = "N")]
    pub ros_domain: Option<u16>,
    /// Networks: loopback, all, or addresses of interfaces. Every computer on these networks can drive the robot.
    #[arg(long, value_name = "IP|all", default_value = "loopback")]
    pub ros_interface: Networks,
    /// As the last option: remappings, namespace and parameters, as of every ROS 2 node.
    #[arg(long, value_name = "ARG", num_args = 1.., allow_hyphen_values = true)]
    pub ros_args: Vec<String>,
}

impl RosArgs {
    /// The options; warns of a network that others share.
    pub fn options(&self) -> Result<Ros2Options, AppError> {
        if let Some(warning) = self.ros_interface.warning() {
            console::print(&format!("warning: {warning}"));
        }
        Ok(Ros2Options::read("trundle", self.ros_domain, self.ros_interface.clone(), &self.ros_args)?)
    }
}

/// trundle's own robot, real or simulated, on ROS 2.
#[derive(Debug, Args)]
pub struct RosRobotArgs {
    /// Publish map, pose and state on ROS 2, and accept goals from there, also after the mission; without a mission the robot waits for goals.
    #[arg(long)]
    pub ros2: bool,
    /// With --ros2: raw images instead of JPEG and PNG.
    #[arg(long, requires = "ros2", hide_short_help = true)]
    pub raw_images: bool,
    /// Network and names.
    #[command(flatten)]
    pub ros: RosArgs,
}

/// The node of a run, the run's end of the link to the node, and the receiver of the body's events.
type RunNode = (Option<RobotNode>, Option<OperatorLink>, Option<EventObserver>);

impl RosRobotArgs {
    /// The node of a run of `robot`, whose stamps count from `origin`, if requested.
    pub fn start(&self, robot: &RobotConfig, origin: Instant) -> Result<RunNode, AppError> {
        if !self.ros2 {
            return Ok((None, None, None));
        }
        let (node, link) = RobotNode::offer(&self.ros.options()?, self.raw_images, robot, origin)?;
        let observer = node.observer();
        Ok((Some(node), Some(link), observer))
    }
}

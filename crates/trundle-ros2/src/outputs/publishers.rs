//! The topics that a robot publishes.

use super::OutputSettings;
use crate::Ros2Error;
use crate::generated::diagnostic_msgs::DiagnosticArray;
use crate::generated::geometry_msgs::PoseWithCovarianceStamped;
use crate::generated::map_msgs::OccupancyGridUpdate;
use crate::generated::nav_msgs::{OccupancyGridMessage, OdometryMessage, PathMessage};
use crate::generated::sensor_msgs::{BatteryState, LaserScan};
use crate::generated::tf2_msgs::TFMessage;
use crate::interface::MessageType;
use crate::node::{Diagnostics, RosNode, qos};
use ros2_client::qos::QosProfile;
use ros2_client::{Publisher, WriteError};

/// A topic that is published.
pub struct OutputTopic<M: MessageType> {
    publisher: Publisher<M>,
    name: String,
    diagnostics: Diagnostics,
}

impl<M: MessageType> OutputTopic<M> {
    /// The topic `name`.
    ///
    /// # Errors
    /// When the topic cannot be created.
    pub fn new(node: &mut RosNode, name: &str, qos: &QosProfile) -> Result<Self, Ros2Error> {
        let publisher = node.publisher(name, qos)?;
        Ok(Self { publisher, name: node.names().resolve(name), diagnostics: node.diagnostics() })
    }

    /// Publishes a message. A message that is not sent is reported, not waited for.
    pub fn publish(&self, message: M) {
        if let Err(error) = self.publisher.publish(message) {
            self.diagnostics.warn(&self.name, format!("a message was not sent: {}", cause(&error)));
        }
    }
}

/// Reason why a message was not sent, without the message.
fn cause<M>(error: &WriteError<M>) -> &'static str {
    match error {
        WriteError::WouldBlock { .. } => "a subscriber does not take messages as fast as they come",
        _ => "the middleware refused it",
    }
}

/// The topics that a robot publishes.
pub struct RobotTopics {
    /// `map` to `odom`, and `odom` to the base if the body does not publish it itself.
    pub tf: OutputTopic<TFMessage>,
    /// Base to camera and scan.
    pub tf_static: OutputTopic<TFMessage>,
    /// Odometry. `None` if the body publishes its own.
    pub odom: Option<OutputTopic<OdometryMessage>>,
    /// The map.
    pub map: OutputTopic<OccupancyGridMessage>,
    /// Changes of the map since the newest update.
    pub map_updates: OutputTopic<OccupancyGridUpdate>,
    /// The scan from depth images. `None` if a laser's scan uses this name.
    pub scan: Option<OutputTopic<LaserScan>>,
    /// The plan.
    pub plan: OutputTopic<PathMessage>,
    /// The pose with its covariance.
    pub amcl_pose: OutputTopic<PoseWithCovarianceStamped>,
    /// Costs of the whole map.
    pub global_costmap: OutputTopic<OccupancyGridMessage>,
    /// Costs around the robot.
    pub local_costmap: OutputTopic<OccupancyGridMessage>,
    /// State of the robot and of its topics.
    pub diagnostics: OutputTopic<DiagnosticArray>,
    /// The battery. `None` if the body publishes its own.
    pub battery: Option<OutputTopic<BatteryState>>,
}

impl RobotTopics {
    /// The topics of a robot.
    ///
    /// # Errors
    /// When a topic cannot be created.
    pub fn new(node: &mut RosNode, settings: &OutputSettings) -> Result<Self, Ros2Error> {
        let own = settings.has_own_body;
        let battery = own.then(|| OutputTopic::new(node, "battery_state", &qos::reliable(1))).transpose()?;
        let odom = own.then(|| OutputTopic::new(node, "odom", &qos::reliable(10))).transpose()?;
        let scan =
            settings.publishes_scan.then(|| OutputTopic::new(node, "scan", &qos::reliable(5))).transpose()?;
        Ok(Self {
            tf: OutputTopic::new(node, "/tf", &qos::reliable(100))?,
            tf_static: OutputTopic::new(node, "/tf_static", &qos::latched())?,
            odom,
            map: OutputTopic::new(node, "map", &qos::latched())?,
            map_updates: OutputTopic::new(node, "map_updates", &qos::reliable(1))?,
            scan,
            plan: OutputTopic::new(node, "plan", &qos::reliable(1))?,
            amcl_pose: OutputTopic::new(node, "amcl_pose", &qos::latched())?,
            global_costmap: OutputTopic::new(node, "global_costmap/costmap", &qos::latched())?,
            local_costmap: OutputTopic::new(node, "local_costmap/costmap", &qos::latched())?,
            diagnostics: OutputTopic::new(node, "/diagnostics", &qos::reliable(10))?,
            battery,
        })
    }
}

//! The topic `/clock`: the body's time as ROS time.

use crate::Ros2Error;
use crate::convert::stamp;
use crate::generated::rosgraph_msgs::Clock;
use crate::node::{RosNode, qos};
use crate::outputs::OutputTopic;
use std::time::{SystemTime, UNIX_EPOCH};
use trundle_core::Stamp;

/// Period of `/clock` \[s\], equal to that of the wheels. Source: ours.
const CLOCK_PERIOD_S: f64 = 0.01;

/// The publisher of `/clock`.
pub(super) struct ClockPublisher {
    topic: OutputTopic<Clock>,
    /// The ROS time of the body's stamp 0 \[ns\].
    origin: i64,
    due: Option<Stamp>,
}

impl ClockPublisher {
    /// Adds the topic to a node; the body's stamp 0 is the present time.
    ///
    /// # Errors
    /// When the topic cannot be created.
    pub(super) fn new(node: &mut RosNode) -> Result<Self, Ros2Error> {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let origin = i64::try_from(since.as_nanos()).unwrap_or_default();
        Ok(Self { topic: OutputTopic::new(node, "/clock", &qos::sensor(1))?, origin, due: None })
    }

    /// The ROS time of a stamp of the body.
    pub(super) fn ros_time(&self, stamp: Stamp) -> Stamp {
        Stamp::from_nanos(self.origin.saturating_add(stamp.nanos))
    }

    /// Publishes a ROS time if the period has passed.
    pub(super) fn publish(&mut self, at: Stamp) {
        if self.due.is_none_or(|due| at >= due) {
            self.due = Some(at.after(CLOCK_PERIOD_S));
            self.topic.publish(Clock { clock: stamp::to_ros(at) });
        }
    }
}

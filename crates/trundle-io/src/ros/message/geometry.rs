//! Transforms, poses and twists.

use super::RosMessage;
use crate::ros::cdr_writer::CdrWriter;
use trundle_core::{Pose3, Stamp, Twist2};

/// A transform: when, parent and child frame, `parent_from_child`.
pub type StampedTransform<'a> = (Stamp, &'a str, &'a str, Pose3);

/// `tf2_msgs/msg/TFMessage`.
#[must_use]
pub fn transforms(transforms: &[StampedTransform<'_>]) -> RosMessage {
    let writer = CdrWriter::new().count(transforms.len());
    let writer = transforms.iter().fold(writer, |writer, (stamp, parent, child, pose)| {
        writer.header(*stamp, parent).string(child).pose(*pose)
    });
    RosMessage::new("tf2_msgs/msg/TFMessage", writer)
}

/// `geometry_msgs/msg/PoseStamped`: `frame_from_body`.
#[must_use]
pub fn pose(stamp: Stamp, frame: &str, pose: Pose3) -> RosMessage {
    RosMessage::new("geometry_msgs/msg/PoseStamped", CdrWriter::with_header(stamp, frame).pose(pose))
}

/// `geometry_msgs/msg/TwistStamped` of the base.
#[must_use]
pub fn twist(stamp: Stamp, frame: &str, twist: Twist2) -> RosMessage {
    RosMessage::new("geometry_msgs/msg/TwistStamped", CdrWriter::with_header(stamp, frame).twist(twist))
}

impl CdrWriter {
    /// Linear and angular velocity of a base in the plane.
    pub(super) fn twist(self, twist: Twist2) -> Self {
        self.f64s([twist.v, 0.0, 0.0, 0.0, 0.0, twist.omega])
    }
}

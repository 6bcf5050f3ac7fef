//! ROS 2 messages of core types, in CDR: what recordings hold and converted bags.

mod geometry;
mod navigation;
mod sensors;
mod status;
mod visualization;

pub use geometry::{StampedTransform, pose, transforms, twist};
pub use navigation::{map, odometry, odometry_pose, path};
pub use sensors::{camera_info, color_image, depth_image, gyro, scan, sweep};
pub use status::{diagnostics, text};
pub use visualization::{PointPair, features, keyframe_graph, points};

pub(in crate::ros) use sensors::NOT_MEASURED;

use crate::ros::cdr_writer::CdrWriter;

/// A message in CDR and its type.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RosMessage {
    kind: &'static str,
    bytes: Vec<u8>,
}

impl RosMessage {
    fn new(kind: &'static str, writer: CdrWriter) -> Self {
        Self { kind, bytes: writer.finish() }
    }

    /// Name of the type, as `nav_msgs/msg/Path`.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.kind
    }

    /// The message in CDR, little endian.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}

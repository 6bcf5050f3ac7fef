//! The JSON messages of a recording for poses and lists of poses.

use super::time::Time;
use crate::EncodedEvent;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose2, Pose3, Stamp};

/// A message of the schema `foxglove.PoseInFrame`. A planar pose also has its heading, because its quaternion does not preserve the last
/// bit of the heading.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PoseInFrame {
    timestamp: Time,
    frame_id: String,
    pose: PoseMessage,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    theta: Option<f64>,
}

impl PoseInFrame {
    /// Name of the schema.
    pub const SCHEMA: &str = "foxglove.PoseInFrame";

    /// A pose in space: `frame_from_body`, m.
    pub fn new(stamp: Stamp, frame_id: &str, pose: Pose3) -> Self {
        Self { timestamp: stamp.into(), frame_id: frame_id.to_owned(), pose: pose.into(), theta: None }
    }

    /// A pose in the plane: `frame_from_body`, m and rad.
    pub fn planar(stamp: Stamp, frame_id: &str, pose: Pose2) -> Self {
        Self { theta: Some(pose.theta), ..Self::new(stamp, frame_id, Pose3::from_pose2(pose)) }
    }

    /// The exact planar pose; `None` for a message made from a pose in space.
    pub fn pose2(&self) -> Option<Pose2> {
        let Xyz { x, y, .. } = self.pose.position;
        self.theta.map(|theta| Pose2 { x, y, theta })
    }
}

/// A message of the schema `foxglove.PosesInFrame`: a path or trajectory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PosesInFrame {
    timestamp: Time,
    frame_id: String,
    poses: Vec<PoseMessage>,
}

impl PosesInFrame {
    /// Name of the schema.
    pub const SCHEMA: &str = "foxglove.PosesInFrame";

    /// Poses in the plane: `frame_from_body` each.
    pub fn planar(stamp: Stamp, frame_id: &str, poses: impl IntoIterator<Item = Pose2>) -> Self {
        let poses = poses.into_iter().map(|pose| Pose3::from_pose2(pose).into()).collect();
        Self { timestamp: stamp.into(), frame_id: frame_id.to_owned(), poses }
    }
}

impl TryFrom<PoseInFrame> for EncodedEvent {
    type Error = Invalid;

    fn try_from(m: PoseInFrame) -> Result<Self, Invalid> {
        let pose = m.pose2().ok_or_else(|| Invalid::new("theta", "absent", "", "a number"))?;
        Ok(Self::Truth { stamp: m.timestamp.try_into()?, pose })
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Xyz {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Xyzw {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct PoseMessage {
    position: Xyz,
    orientation: Xyzw,
}

impl From<Pose3> for PoseMessage {
    fn from(pose: Pose3) -> Self {
        let [x, y, z, i, j, k, w] = pose.into();
        Self { position: Xyz { x, y, z }, orientation: Xyzw { x: i, y: j, z: k, w } }
    }
}

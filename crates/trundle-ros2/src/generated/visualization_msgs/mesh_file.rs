//! `visualization_msgs/msg/MeshFile`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `visualization_msgs`: `MeshFile`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MeshFile {
    /// `string`.
    pub filename: std::string::String,
    /// `uint8[]`.
    pub data: crate::wire::Bytes,
}

impl ros2_client::Message for MeshFile {}

impl crate::interface::MessageType for MeshFile {
    const PACKAGE: &str = "visualization_msgs";
    const NAME: &str = "MeshFile";
}

//! `visualization_msgs/msg/Marker`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `visualization_msgs`: `Marker`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Marker {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `string`.
    pub ns: std::string::String,
    /// `int32`.
    pub id: i32,
    /// `int32`.
    pub r#type: i32,
    /// `int32`.
    pub action: i32,
    /// `geometry_msgs/Pose`.
    pub pose: crate::generated::geometry_msgs::Pose,
    /// `geometry_msgs/Vector3`.
    pub scale: crate::generated::geometry_msgs::Vector3Message,
    /// `std_msgs/ColorRGBA`.
    pub color: crate::generated::std_msgs::ColorRGBA,
    /// `builtin_interfaces/Duration`.
    pub lifetime: crate::generated::builtin_interfaces::Duration,
    /// `bool`.
    pub frame_locked: bool,
    /// `geometry_msgs/Point[]`.
    pub points: Vec<crate::generated::geometry_msgs::Point>,
    /// `std_msgs/ColorRGBA[]`.
    pub colors: Vec<crate::generated::std_msgs::ColorRGBA>,
    /// `string`.
    pub texture_resource: std::string::String,
    /// `sensor_msgs/CompressedImage`.
    pub texture: crate::generated::sensor_msgs::CompressedImage,
    /// `UVCoordinate[]`.
    pub uv_coordinates: Vec<crate::generated::visualization_msgs::UVCoordinate>,
    /// `string`.
    pub text: std::string::String,
    /// `string`.
    pub mesh_resource: std::string::String,
    /// `MeshFile`.
    pub mesh_file: crate::generated::visualization_msgs::MeshFile,
    /// `bool`.
    pub mesh_use_embedded_materials: bool,
}

impl ros2_client::Message for Marker {}

impl Marker {
    /// `int32`.
    pub const ARROW: i32 = 0;
    /// `int32`.
    pub const CUBE: i32 = 1;
    /// `int32`.
    pub const SPHERE: i32 = 2;
    /// `int32`.
    pub const CYLINDER: i32 = 3;
    /// `int32`.
    pub const LINE_STRIP: i32 = 4;
    /// `int32`.
    pub const LINE_LIST: i32 = 5;
    /// `int32`.
    pub const CUBE_LIST: i32 = 6;
    /// `int32`.
    pub const SPHERE_LIST: i32 = 7;
    /// `int32`.
    pub const POINTS: i32 = 8;
    /// `int32`.
    pub const TEXT_VIEW_FACING: i32 = 9;
    /// `int32`.
    pub const MESH_RESOURCE: i32 = 10;
    /// `int32`.
    pub const TRIANGLE_LIST: i32 = 11;
    /// `int32`.
    pub const ARROW_STRIP: i32 = 12;
    /// `int32`.
    pub const ADD: i32 = 0;
    /// `int32`.
    pub const MODIFY: i32 = 0;
    /// `int32`.
    pub const DELETE: i32 = 2;
    /// `int32`.
    pub const DELETEALL: i32 = 3;
}

impl crate::interface::MessageType for Marker {
    const PACKAGE: &str = "visualization_msgs";
    const NAME: &str = "Marker";
}

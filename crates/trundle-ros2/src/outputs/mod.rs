//! The robot's state as topics, with the names and types of Nav2.

pub mod costmap;
mod frames;
mod node_guard;
mod published_map;
mod publishers;
mod robot_outputs;
mod run_frames;

pub use frames::FrameNames;
pub use published_map::PublishedMap;
pub use publishers::{OutputTopic, RobotTopics};
pub use robot_outputs::{OutputSources, RobotOutputs};
pub use run_frames::RunFrames;

/// Topics that a robot publishes.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OutputSettings {
    /// Name of the node.
    pub node: String,
    /// Whether the body is trundle's own: odometry, its transform and the battery are published too.
    pub has_own_body: bool,
    /// Whether the scan from depth images is published.
    pub publishes_scan: bool,
    /// Range of the scan from depth images \[m\].
    pub scan_range_m: f64,
    /// Radius of the largest disc in the body \[m\], for the costs.
    pub body_radius_m: f64,
}

impl OutputSettings {
    /// The settings of `robot`. `has_own_body`: whether the body is trundle's own and not one by ROS topics.
    #[must_use]
    pub fn of(
        options: &crate::Ros2Options,
        robot: &trundle_runtime::RobotConfig,
        has_own_body: bool,
    ) -> Self {
        Self {
            node: options.node.names.node.clone(),
            has_own_body,
            publishes_scan: true,
            scan_range_m: robot.scan.max_range,
            body_radius_m: robot.footprint_radius,
        }
    }
}

//! A body of trundle offered to ROS 2: the simulator as a ROS 2 robot, the sensors of a run's own body.

mod body_server;
mod clock_publisher;
mod image_publisher;
mod sensor_topics;

pub use body_server::{BodyServer, OfferedBody, serve_body};
pub use image_publisher::ImagePublisher;
pub use sensor_topics::SensorTopics;

use crate::outputs::FrameNames;

/// Settings of an offered body.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ServerSettings {
    /// Names of frames.
    pub frames: FrameNames,
    /// Whether commands are `TwistStamped`, else `Twist`.
    pub stamped_commands: bool,
    /// Whether images are published raw, else as JPEG and PNG files.
    pub raw_images: bool,
}

impl ServerSettings {
    /// Settings with images as JPEG and PNG files.
    pub const fn new(frames: FrameNames, stamped_commands: bool) -> Self {
        Self { frames, stamped_commands, raw_images: false }
    }
}

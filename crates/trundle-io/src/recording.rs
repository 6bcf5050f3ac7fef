//! Recordings of a run: MCAP with JSON messages and images as ROS 2 has them, which Foxglove Studio opens as it is.

mod chunk_decoder;
mod cut;
mod messages;
mod poses;
mod reader;
mod record_parser;
mod recorder;
mod ros_image;
mod schemas;
mod stream;
mod time;
mod unpacked;
mod visual_map;

pub use poses::{PoseInFrame, PosesInFrame};
pub use reader::{RecordedMessage, RecordingReader};
pub use recorder::Recorder;
pub use stream::RecordingCut;
pub(crate) use stream::{Encoding, MessageStream, RawMessage};
pub use visual_map::{FeatureMarks, KeyframeGraph, LandmarkCloud};

/// Where each kind of sensor event is recorded.
mod topics {
    pub const WHEELS: &str = "/wheels";
    pub const GYRO: &str = "/gyro";
    pub const TOUCH: &str = "/touch";
    pub const CLIFF: &str = "/cliff";
    /// Odometry that the body computes itself.
    pub const ODOMETRY: &str = "/odometry";
    /// Power, wheel drop, buttons, links, silence.
    pub const BODY: &str = "/body";
    pub const SCAN: &str = "/scan";
    pub const TRUTH: &str = "/truth";
    pub const COLOR: &str = "/camera/color";
    pub const DEPTH: &str = "/camera/depth";
}

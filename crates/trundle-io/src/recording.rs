//! Recordings of a run: MCAP with messages of ROS 2 in CDR, which RViz, Foxglove, Rerun and rosbags open without conversion. Recordings of
//! JSON, as earlier versions wrote them, are read too.

mod channels;
mod chunk_decoder;
mod container;
mod cut;
mod damage;
mod images;
mod messages;
mod poses;
mod reader;
mod record_parser;
mod recorder;
mod stream;
mod time;
mod unpacked;

pub(crate) use channels::{Encoding, RawMessage};
pub use cut::RecordingCut;
pub use poses::{PoseInFrame, PosesInFrame};
pub use reader::{RecordedMessage, RecordingReader};
pub use recorder::Recorder;
pub(crate) use stream::MessageStream;

/// The name of the writer in the header of a recording.
pub(crate) const LIBRARY: &str = "trundle";

/// Topics of a recording.
mod topics {
    /// Prefix of the topics needed by a replay.
    pub const PRIVATE: &str = "/trundle";
    /// The key in a channel's metadata for the schema of its JSON.
    pub const SCHEMA_KEY: &str = "trundle_schema";
    // Topics of the sensor events.
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
    /// The place of an image among the events.
    pub const IMAGE: &str = "/image";
    pub const COLOR: &str = "/camera/color/image_raw/compressed";
    pub const DEPTH: &str = "/camera/depth/image_raw/compressedDepth";
    pub const COLOR_INFO: &str = "/camera/color/camera_info";
    pub const DEPTH_INFO: &str = "/camera/depth/camera_info";
    /// Images of recordings of JSON: depth right behind colour.
    pub const OLD_COLOR: &str = "/camera/color";
    pub const OLD_DEPTH: &str = "/camera/depth";
}

//! Recordings of a run: MCAP with JSON messages, which Foxglove Studio opens as it is.

mod chunk_decoder;
mod messages;
mod poses;
mod reader;
mod recorder;
mod schemas;
mod stream;
mod time;
mod visual_map;

pub use poses::{PoseInFrame, PosesInFrame};
pub use reader::{RecordedMessage, RecordingReader};
pub use recorder::Recorder;
pub(crate) use stream::{Encoding, MessageStream, RawMessage};
pub use visual_map::{FeatureMarks, KeyframeGraph, LandmarkCloud};

/// Where each kind of sensor event is recorded.
mod topics {
    pub const WHEELS: &str = "/wheels";
    pub const GYRO: &str = "/gyro";
    pub const TOUCH: &str = "/touch";
    pub const CLIFF: &str = "/cliff";
    pub const SCAN: &str = "/scan";
    pub const TRUTH: &str = "/truth";
    pub const COLOR: &str = "/camera/color";
    pub const DEPTH: &str = "/camera/depth";
}

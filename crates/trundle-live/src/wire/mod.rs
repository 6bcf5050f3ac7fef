//! The messages of the page: text as JSON, large parts as bytes.
//!
//! The page sends [`Request`]s as JSON. The server sends [`Reply`]s as JSON, and messages of bytes, little-endian, whose first byte is
//! their [`Kind`]. Unless stated otherwise, data is in the map frame; m and rad.

mod depth;
mod features;
mod image;
mod map_tiles;
mod path;
mod reply;
mod request;
mod run_setting;
mod scan;
mod state;
mod visual_map;

pub use depth::depth_message;
pub use features::features_message;
pub use image::image_message;
pub use map_tiles::{MapTiles, TileCursor};
pub use path::{path_message, trail_message};
pub use reply::{RecordingText, Reply, SeriesText, StateEntry, Welcome};
pub use request::{Goal, Request};
pub use run_setting::SettingText;
pub use scan::scan_message;
pub use state::{StateMessage, WheelText};
pub use visual_map::visual_map_message;

/// Version of the messages. A page of another version reloads itself. Source: ours.
pub const WIRE_VERSION: u32 = 5;

/// First byte of a message of bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Kind {
    /// Tiles of the map.
    MapTiles = 1,
    /// The points of a scan.
    Scan = 2,
    /// The planned path with its way-points.
    Plan = 3,
    /// A colour image.
    Image = 4,
    /// The driven path.
    Trail = 5,
    /// Keyframes and landmarks.
    VisualMap = 6,
    /// Features of the last image, and the number of closed loops.
    Features = 7,
    /// The depth of an image.
    Depth = 8,
}

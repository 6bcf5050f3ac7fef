//! The header of a camera stream, which is also the file `camera.json` of a folder.

use crate::camera::frame_monitor::check_intrinsics;
use crate::camera::{CameraInfo, StreamInfo};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};
use trundle_core::{Invalid, Pose3, require_in, require_positive};

/// First word of the header.
const STREAM_MAGIC: &str = "trundle-camera";
/// First bytes of a header in a stream. Source: docs/camera-stream.md.
const HEADER_START: &[u8] = br#"{"magic":"trundle-camera""#;
/// Version of the form. Source: docs/camera-stream.md.
const STREAM_VERSION: u32 = 1;
/// Longest header \[bytes\]. Source: ours; a header has about 800 bytes.
const MAX_HEADER_BYTES: usize = 65_536;
/// Longest delay of a camera \[s\]. Source: ours; a longer one is a mistyped number.
const MAX_DELAY_S: f64 = 1.0;
/// Highest frame rate \[Hz\]. Source: ours; a higher one is a mistyped number.
const MAX_RATE_HZ: f64 = 1000.0;
/// Largest unit of whole-numbered depth \[m\]. Source: ours; 65535 units are 6.5 km.
const MAX_DEPTH_UNIT_M: f64 = 0.1;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    magic: String,
    version: u32,
    #[serde(default)]
    name: String,
    #[serde(default)]
    serial: String,
    #[serde(default)]
    firmware: String,
    #[serde(deserialize_with = "color_stream")]
    color: StreamInfo,
    #[serde(deserialize_with = "depth_stream")]
    depth: StreamInfo,
    #[serde(default = "millimetre")]
    depth_unit_m: f64,
    #[serde(default)]
    color_from_depth: Option<Pose3>,
    #[serde(default)]
    delay_s: f64,
    #[serde(default = "yes")]
    live: bool,
}

fn color_stream<'de, D: Deserializer<'de>>(header: D) -> Result<StreamInfo, D::Error> {
    named_stream("color", header)
}

fn depth_stream<'de, D: Deserializer<'de>>(header: D) -> Result<StreamInfo, D::Error> {
    named_stream("depth", header)
}

/// A stream of the header; errors contain the stream's name.
fn named_stream<'de, D: Deserializer<'de>>(name: &str, header: D) -> Result<StreamInfo, D::Error> {
    StreamInfo::deserialize(header).map_err(|error| D::Error::custom(format!("{name}: {error}")))
}

fn millimetre() -> f64 {
    0.001
}

fn yes() -> bool {
    true
}

/// The header of a stream as one line of JSON, with its end of line.
///
/// # Errors
/// When the camera's numbers would be refused by [`parse_header`].
pub fn header_line(info: &CameraInfo) -> Result<String, String> {
    check(info).map_err(|error| error.to_string())?;
    let header = Header {
        magic: STREAM_MAGIC.into(),
        version: STREAM_VERSION,
        name: info.name.clone(),
        serial: info.serial.clone(),
        firmware: info.firmware.clone(),
        color: info.color,
        depth: info.depth,
        depth_unit_m: info.depth_unit_m,
        color_from_depth: info.color_from_depth,
        delay_s: info.delay_s,
        live: info.is_live,
    };
    let line = serde_json::to_string(&header).map_err(|error| error.to_string())?;
    Ok(line + "\n")
}

/// The camera that a header describes.
///
/// # Errors
/// A sentence with the field: no JSON, another magic or version, or a number out of range.
pub fn parse_header(bytes: &[u8]) -> Result<CameraInfo, String> {
    if bytes.len() > MAX_HEADER_BYTES {
        return Err(format!("the header has {} bytes, expected at most {MAX_HEADER_BYTES}", bytes.len()));
    }
    let header: Header = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
    if header.magic != STREAM_MAGIC {
        return Err(format!("magic is {:?}, expected {STREAM_MAGIC:?}", header.magic));
    }
    if header.version != STREAM_VERSION {
        return Err(format!("version is {}, expected {STREAM_VERSION}", header.version));
    }
    let info = info(header);
    check(&info).map_err(|error| error.to_string())?;
    Ok(info)
}

/// Result of the search for a header in the bytes of a stream.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum HeaderSearch {
    /// A whole header, with its end of line.
    Found(std::ops::Range<usize>),
    /// More bytes are needed; no header begins before this position.
    From(usize),
}

/// Searches for a header, which begins a stream and may be repeated between frames.
///
/// # Errors
/// When no line ends within the longest header.
pub(super) fn find_header(bytes: &[u8]) -> Result<HeaderSearch, String> {
    let is_start = |window: &[u8]| HEADER_START.starts_with(&window[..window.len().min(HEADER_START.len())]);
    let candidates = bytes.iter().enumerate().filter(|(_, byte)| **byte == HEADER_START[0]);
    let Some(start) = candidates.map(|(at, _)| at).find(|at| is_start(&bytes[*at..])) else {
        return Ok(HeaderSearch::From(bytes.len()));
    };
    match bytes[start..].iter().take(MAX_HEADER_BYTES).position(|byte| *byte == b'\n') {
        Some(length) => Ok(HeaderSearch::Found(start..start + length + 1)),
        None if bytes.len() - start < MAX_HEADER_BYTES => Ok(HeaderSearch::From(start)),
        None => Err(format!("no line ends within {MAX_HEADER_BYTES} bytes")),
    }
}

fn info(header: Header) -> CameraInfo {
    CameraInfo {
        name: header.name,
        serial: header.serial,
        firmware: header.firmware,
        usb: None,
        color: header.color,
        depth: header.depth,
        depth_unit_m: header.depth_unit_m,
        color_from_depth: header.color_from_depth,
        delay_s: header.delay_s,
        is_live: header.live,
    }
}

fn check(info: &CameraInfo) -> Result<(), Invalid> {
    if info.color.format.is_depth() {
        return Err(Invalid::new("color.format", info.color.format, "", "a colour format"));
    }
    if !info.depth.format.is_depth() {
        return Err(Invalid::new("depth.format", info.depth.format, "", "a depth format"));
    }
    for (name, stream) in [("color", &info.color), ("depth", &info.depth)] {
        let at = |error: Invalid| Invalid { field: format!("{name}.camera.{}", error.field), ..error };
        check_intrinsics(&stream.camera).map_err(at)?;
        let rate = format!("{name}.rate_hz");
        require_positive(&rate, stream.rate_hz, "Hz")?;
        require_in(&rate, stream.rate_hz, "Hz", 0.0, MAX_RATE_HZ)?;
    }
    require_positive("depth_unit_m", info.depth_unit_m, "m")?;
    require_in("depth_unit_m", info.depth_unit_m, "m", 0.0, MAX_DEPTH_UNIT_M)?;
    require_in("delay_s", info.delay_s, "s", 0.0, MAX_DELAY_S)?;
    check_pose(info)
}

fn check_pose(info: &CameraInfo) -> Result<(), Invalid> {
    let expected = "7 finite numbers x y z qx qy qz qw, the quaternion not zero";
    match info.color_from_depth {
        Some(pose) if !pose.is_finite() => Err(Invalid::new("color_from_depth", "not a pose", "", expected)),
        _ => Ok(()),
    }
}

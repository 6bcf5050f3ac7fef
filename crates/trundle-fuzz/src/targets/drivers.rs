//! Streams of devices, and mission files.

use crate::scratch::with_file;
use std::io::BufReader;
use trundle::drivers::camera::kinect2::{DumpReader, parse_dump_header};
use trundle::drivers::camera::pipe::{FrameLimits, FrameParser, parse_header};
use trundle::drivers::camera::pixels::{color_from_raw, depth_from_raw};
use trundle::drivers::kobuki::fuzz_decoder;

/// The serial stream of a Kobuki, both ways.
pub fn kobuki(bytes: &[u8]) {
    fuzz_decoder(bytes);
}

/// A camera stream: its header line, then frames, converted.
pub fn camera_stream(bytes: &[u8]) {
    let end = bytes.iter().position(|byte| *byte == b'\n').map_or(bytes.len(), |at| at + 1);
    let (header, frames) = bytes.split_at(end);
    let Ok(info) = parse_header(header) else { return };
    let mut parser = FrameParser::new(FrameLimits::of(&info));
    parser.push(frames);
    while let Some(frame) = parser.next_frame() {
        let frame = frame.into_camera_frame(&info);
        let (mut color, mut depth) = Default::default();
        let _ = color_from_raw(&frame.color, &mut color);
        let _ = depth_from_raw(&frame.depth, info.depth_unit_m, &mut depth);
    }
}

/// A dump of a Kinect V2.
pub fn kinect2_dump(bytes: &[u8]) {
    let _ = parse_dump_header(bytes);
    let Ok(mut reader) = DumpReader::new(BufReader::new(bytes)) else { return };
    while let Ok(Some(_)) = reader.next_frame() {}
}

/// A mission file.
pub fn mission(bytes: &[u8]) {
    let _ = with_file("mission.toml", bytes, trundle::app::read_mission);
}

//! Streams of devices, and mission files.

use crate::scratch::with_file;
use std::io::BufReader;
use trundle::drivers::camera::kinect2::usb::color_packets::ColorPackets;
use trundle::drivers::camera::kinect2::usb::depth_packets::DepthPackets;
use trundle::drivers::camera::kinect2::usb::reply::ReplyReader;
use trundle::drivers::camera::kinect2::usb::{answers, calibration, descriptor, ids};
use trundle::drivers::camera::kinect2::{DumpReader, parse_dump_header};
use trundle::drivers::camera::pipe::{FrameLimits, FrameParser, parse_header};
use trundle::drivers::camera::pixels::{color_from_raw, depth_from_raw};
use trundle::drivers::kobuki::fuzz_decoder;

/// Maximum number of packets of zeros for one input. Source: ours; two frames of depth, and a rest.
const MAX_ZERO_PACKETS: usize = 32;
/// Number of zero bytes for each step of their length: 37,312 of them are an image of depth.
const ZERO_STEP_BYTES: usize = 8;

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

/// Arrivals of a Kinect V2 at its USB endpoints: kind, length of two bytes, bytes.
pub fn kinect2_usb(bytes: &[u8]) {
    let (mut depth, mut color) = (DepthPackets::default(), ColorPackets::default());
    let (mut reply, mut zeros) = (ReplyReader::new(1, 0x1c_0000), 0);
    let mut rest = bytes;
    while let [kind, low, high, following @ ..] = rest {
        let length = usize::from(u16::from_le_bytes([*low, *high]));
        let is_zeros = kind % 8 == 4;
        let (packet, following) = following.split_at(if is_zeros { 0 } else { length.min(following.len()) });
        match kind % 8 {
            0 => drop(depth.push(packet)),
            1 => drop(color.push(packet)),
            2 => drop(reply.push(packet)),
            3 => (depth.lose(), color.lose()).0,
            4 if zeros < MAX_ZERO_PACKETS => {
                zeros += 1;
                drop(depth.push(&vec![0; length * ZERO_STEP_BYTES]));
            }
            5 => drop((answers::firmware(packet), answers::serial_number(packet), answers::is_ready(packet))),
            6 => drop((calibration::depth_camera(packet), calibration::color_camera(packet))),
            _ => drop(descriptor::bytes_per_interval(packet, ids::DEPTH_INTERFACE, 1, ids::DEPTH_ENDPOINT)),
        }
        rest = following;
    }
    let _ = calibration::p0_tables(bytes);
}

/// A mission file.
pub fn mission(bytes: &[u8]) {
    let _ = with_file("mission.toml", bytes, trundle::app::read_mission);
}

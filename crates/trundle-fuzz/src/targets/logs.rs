//! Laser logs, bags and recordings.

use crate::scratch::with_file;
use mcap::WriteOptions;
use mcap::records::MessageHeader;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;
use trundle::io::{
    Expected, FileKind, LaserLogOptions, RecordingReader, RosSequence, RosSequenceOptions, read_laser_log,
    read_ros_bag,
};

/// A laser log of any kind, recognised by its content.
pub fn laser_log(bytes: &[u8]) {
    let _ = with_file("robot.log", bytes, |path| read_laser_log(path, &LaserLogOptions::default()));
}

/// A ROS 2 bag in one file: its scans, its images.
pub fn bag(bytes: &[u8]) {
    with_file("bag", bytes, |path| {
        let _ = read_ros_bag(path, &LaserLogOptions::default());
        read_images(path);
    });
}

fn read_images(path: &Path) {
    let Ok(sequence) = RosSequence::open(path, &RosSequenceOptions::default(), false) else { return };
    let Ok(frames) = sequence.frames(1000.0) else { return };
    for frame in frames.flatten() {
        let _ = frame.decode();
    }
}

/// Any file, whose kind is recognised by its content.
pub fn file_kind(bytes: &[u8]) {
    let _ = FileKind::of_bytes(bytes, bytes.len() as u64);
    let _ = with_file("anything", bytes, |path| Expected::LaserLog.check(path));
}

/// A message of a ROS 2 bag, read as each of the known types.
pub fn cdr(bytes: &[u8]) {
    bag(&bag_of(bytes).expect("invariant: a bag in memory can be written"));
}

/// A bag that holds `message` once for each type.
fn bag_of(message: &[u8]) -> Result<Vec<u8>, mcap::McapError> {
    let mut writer = WriteOptions::new().compression(None).create(Cursor::new(Vec::new()))?;
    let types = [
        ("/tf", "tf2_msgs/msg/TFMessage"),
        ("/odom", "nav_msgs/msg/Odometry"),
        ("/scan", "sensor_msgs/msg/LaserScan"),
        ("/image", "sensor_msgs/msg/Image"),
        ("/image/compressed", "sensor_msgs/msg/CompressedImage"),
        ("/camera_info", "sensor_msgs/msg/CameraInfo"),
    ];
    for (sequence, (topic, kind)) in (0_u32..).zip(types) {
        let schema_id = writer.add_schema(kind, "ros2msg", b"")?;
        let channel_id = writer.add_channel(schema_id, topic, "cdr", &BTreeMap::new())?;
        let header = MessageHeader { channel_id, sequence, log_time: 1, publish_time: 1 };
        writer.write_to_known_channel(&header, message)?;
    }
    writer.finish()?;
    Ok(writer.into_inner().into_inner())
}

/// A recording of a run: its setup, and every message with its images decoded.
pub fn recording(bytes: &[u8]) {
    with_file("recording.mcap", bytes, |path| {
        let _ = trundle::app::RunReplayer::open(path);
        read_events(path);
    });
}

fn read_events(path: &Path) {
    let Ok(reader) = RecordingReader::open(path) else { return };
    for event in reader.events() {
        let Ok(event) = event else { return };
        let _ = event.decode();
    }
}

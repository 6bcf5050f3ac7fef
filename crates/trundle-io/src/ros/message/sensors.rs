//! Images, camera_info, gyro and sweeps.

use super::RosMessage;
use crate::ros::cdr_writer::CdrWriter;
use trundle_core::{Beam, BeamTimes, GyroRate, PinholeCamera, Scan, Stamp};

/// Bytes in front of a depth image: no quantisation. Source: `compressed_depth_image_transport`.
const DEPTH_HEADER: [u8; 12] = [0; 12];
/// Maximum range of a sweep by trundle \[m\]. Source: ours, more than any room.
const MAX_RANGE_M: f32 = 100.0;
/// Covariance of a quantity that was not measured. Source: sensor_msgs/msg/Imu.
pub(in crate::ros) const NOT_MEASURED: f64 = -1.0;

/// `sensor_msgs/msg/CompressedImage` of colour: the bytes of a JPEG or PNG.
#[must_use]
pub fn color_image(stamp: Stamp, frame: &str, picture: &[u8]) -> RosMessage {
    let format = if picture.starts_with(b"\x89PNG") { "png" } else { "jpeg" };
    compressed(stamp, frame, format, &[picture])
}

/// `sensor_msgs/msg/CompressedImage` of depth in millimetres: a PNG, or RVL behind width and height.
#[must_use]
pub fn depth_image(stamp: Stamp, frame: &str, depth: &[u8]) -> RosMessage {
    let is_png = depth.starts_with(b"\x89PNG");
    let format = if is_png { "16UC1; compressedDepth png" } else { "16UC1; compressedDepth rvl" };
    compressed(stamp, frame, format, &[&DEPTH_HEADER, depth])
}

fn compressed(stamp: Stamp, frame: &str, format: &str, parts: &[&[u8]]) -> RosMessage {
    let writer = CdrWriter::with_header(stamp, frame).string(format).bytes(&parts.concat());
    RosMessage::new("sensor_msgs/msg/CompressedImage", writer)
}

/// `sensor_msgs/msg/CameraInfo` of raw images.
#[must_use]
pub fn camera_info(stamp: Stamp, frame: &str, camera: &PinholeCamera) -> RosMessage {
    let (fx, fy, cx, cy) = (camera.fx(), camera.fy(), camera.cx(), camera.cy());
    let lens = camera.distortion();
    let writer = CdrWriter::with_header(stamp, frame).count(camera.height()).count(camera.width());
    let writer = writer.string("plumb_bob").count(5).f64s([lens.k1, lens.k2, lens.p1, lens.p2, lens.k3]);
    let writer = writer.f64s([fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]);
    let writer = writer.f64s([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    let writer = writer.f64s([fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let writer = writer.u32(0).u32(0).u32(0).u32(0).u32(0).u32(0).u8(0);
    RosMessage::new("sensor_msgs/msg/CameraInfo", writer)
}

/// `sensor_msgs/msg/Imu` of a gyro around the vertical axis, without other measurements.
#[must_use]
pub fn gyro(frame: &str, rate: &GyroRate) -> RosMessage {
    let writer = CdrWriter::with_header(rate.stamp, frame).f64s([0.0, 0.0, 0.0, 1.0]);
    let unmeasured = [NOT_MEASURED, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let writer = writer.f64s(unmeasured).f64s([0.0, 0.0, rate.omega]).f64s([0.0; 9]);
    RosMessage::new("sensor_msgs/msg/Imu", writer.f64s([0.0; 3]).f64s(unmeasured))
}

/// `sensor_msgs/msg/LaserScan` in a frame at the sweep's origin: infinite for a beam without a return, NaN for an unknown beam.
#[must_use]
pub fn scan(frame: &str, scan: &Scan) -> RosMessage {
    let (first, step, count) = (scan.angle_min(), scan.angle_increment(), scan.beams().len());
    let last = first + step * count.saturating_sub(1) as f64;
    let writer = CdrWriter::with_header(scan.stamp(), frame);
    let writer = writer.f32s([first as f32, last as f32, step as f32, 0.0, 0.0, 0.0, MAX_RANGE_M]);
    let writer = writer.count(count).f32s(scan.beams().iter().map(range)).count(0);
    RosMessage::new("sensor_msgs/msg/LaserScan", writer)
}

/// As [`scan`], for a reader that needs all of a laser's sweep: the beams in the order of their times, the time between them, and the range up
/// to which beams without a return are free.
#[must_use]
pub fn sweep(frame: &str, scan: &Scan) -> RosMessage {
    let last = scan.beams().len().saturating_sub(1);
    let times = scan.beam_times().unwrap_or(BeamTimes { first_s: 0.0, step_s: 0.0 });
    let falls = times.step_s < 0.0;
    let (first, end) = if falls { (last, 0) } else { (0, last) };
    let step = scan.angle_increment() * if falls { -1.0 } else { 1.0 };
    let writer = CdrWriter::with_header(scan.stamp().after(times.of(first)), frame);
    let fields = [scan.angle(first), scan.angle(end), step, times.step_s.abs(), 0.0, 0.0, free_range(scan)];
    let writer = writer.f32s(fields.map(|field| field as f32)).count(scan.beams().len());
    let ranges = scan.beams().iter().map(range);
    let writer = if falls { writer.f32s(ranges.rev()) } else { writer.f32s(ranges) };
    RosMessage::new("sensor_msgs/msg/LaserScan", writer.count(0))
}

/// Range up to which the beams without a return are free \[m\]; [`MAX_RANGE_M`] if every beam has a return.
fn free_range(scan: &Scan) -> f64 {
    let free = scan.beams().iter().filter_map(|beam| match beam {
        Beam::Free { range } => Some(*range),
        _ => None,
    });
    free.reduce(f64::max).unwrap_or(f64::from(MAX_RANGE_M))
}

fn range(beam: &Beam) -> f32 {
    match beam {
        Beam::Hit { range } => *range as f32,
        Beam::Free { .. } => f32::INFINITY,
        Beam::Unseen => f32::NAN,
    }
}

//! Features, landmarks and the graph of keyframes.

use super::RosMessage;
use crate::ros::cdr_writer::CdrWriter;
use trundle_core::{Pose3, Stamp, Vector2, Vector3};

/// Type of a field: 32-bit float. Source: `sensor_msgs/msg/PointField`.
const FLOAT32_TYPE: u8 = 7;
/// Type of a marker: pairs of points as lines. Source: `visualization_msgs/msg/Marker`.
const LINE_LIST: u32 = 5;
/// Type of a marker in an image: points. Source: `visualization_msgs/msg/ImageMarker`.
const IMAGE_POINTS: u32 = 4;
/// Width of a line of the covisibility graph \[m\]. Source: ours.
const LINE_WIDTH_M: f64 = 0.004;
/// Width of a line of a closed loop \[m\]. Source: ours.
const LOOP_WIDTH_M: f64 = 0.012;
/// Size of a feature \[px\]. Source: ours.
const FEATURE_PX: f32 = 3.0;
/// Colours: red, green, blue, opacity. Source: ours.
const TRACKED_COLOR: [f32; 4] = [0.1, 0.8, 0.3, 1.0];
const UNTRACKED_COLOR: [f32; 4] = [1.0, 0.8, 0.1, 0.8];
const COVISIBLE_COLOR: [f32; 4] = [0.3, 0.7, 1.0, 0.5];
const LOOP_COLOR: [f32; 4] = [0.9, 0.3, 0.1, 1.0];

/// Two points of a line, m.
pub type PointPair = (Vector3, Vector3);

/// `visualization_msgs/msg/ImageMarker`: features at raw pixels, green if matched with landmarks, otherwise yellow.
#[must_use]
pub fn features(stamp: Stamp, frame: &str, features: &[(Vector2, bool)]) -> RosMessage {
    let writer = CdrWriter::with_header(stamp, frame).string("features").u32(0).u32(IMAGE_POINTS).u32(0);
    let writer =
        writer.f64s([0.0; 3]).f32(FEATURE_PX).f32s(TRACKED_COLOR).u8(0).f32s(TRACKED_COLOR).u32(0).u32(0);
    let point = |writer: CdrWriter, (p, _): &(Vector2, bool)| writer.f64s([p.x, p.y, 0.0]);
    let writer = features.iter().fold(writer.count(features.len()), point);
    let color = |writer: CdrWriter, (_, is_tracked): &(Vector2, bool)| {
        writer.f32s(if *is_tracked { TRACKED_COLOR } else { UNTRACKED_COLOR })
    };
    let writer = features.iter().fold(writer.count(features.len()), color);
    RosMessage::new("visualization_msgs/msg/ImageMarker", writer)
}

/// `sensor_msgs/msg/PointCloud2` of x, y, z as 32-bit floats, m.
#[must_use]
pub fn points(stamp: Stamp, frame: &str, points: impl IntoIterator<Item = Vector3>) -> RosMessage {
    let bytes = |p: Vector3| [p.x, p.y, p.z].into_iter().flat_map(|v| (v as f32).to_le_bytes());
    let data: Vec<u8> = points.into_iter().flat_map(bytes).collect();
    let writer = CdrWriter::with_header(stamp, frame).u32(1).count(data.len() / 12).count(3);
    let field =
        |writer: CdrWriter, (i, name): (u32, &str)| writer.string(name).u32(4 * i).u8(FLOAT32_TYPE).u32(1);
    let writer = [(0, "x"), (1, "y"), (2, "z")].into_iter().fold(writer, field);
    let writer = writer.u8(0).u32(12).count(data.len()).bytes(&data).u8(1);
    RosMessage::new("sensor_msgs/msg/PointCloud2", writer)
}

/// `visualization_msgs/msg/MarkerArray`: links between keyframes that share landmarks, and closed loops. A later message replaces an
/// earlier one.
#[must_use]
pub fn keyframe_graph(stamp: Stamp, frame: &str, covisible: &[PointPair], loops: &[PointPair]) -> RosMessage {
    let writer = CdrWriter::new().count(2);
    let writer = lines(writer, (stamp, frame), "covisibility", (COVISIBLE_COLOR, LINE_WIDTH_M), covisible);
    let writer = lines(writer, (stamp, frame), "loops", (LOOP_COLOR, LOOP_WIDTH_M), loops);
    RosMessage::new("visualization_msgs/msg/MarkerArray", writer)
}

/// A marker of lines.
fn lines(
    writer: CdrWriter,
    (stamp, frame): (Stamp, &str),
    name: &str,
    (color, width): ([f32; 4], f64),
    pairs: &[PointPair],
) -> CdrWriter {
    let writer = writer.header(stamp, frame).string(name).u32(0).u32(LINE_LIST).u32(0);
    let writer = writer.pose(Pose3::identity()).f64s([width, 0.0, 0.0]).f32s(color);
    let writer = writer.u32(0).u32(0).u8(0).count(2 * pairs.len()); // lifetime, frame_locked
    let point = |writer: CdrWriter, p: Vector3| writer.f64s([p.x, p.y, p.z]);
    let writer = pairs.iter().fold(writer, |writer, (a, b)| point(point(writer, *a), *b));
    // No colours, texture, coordinates, text and mesh.
    let writer = writer.count(0).string("").header(Stamp::default(), "").string("").bytes(&[]);
    writer.count(0).string("").string("").string("").bytes(&[]).u8(0)
}

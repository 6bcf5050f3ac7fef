//! The JSON messages of a recording for image features and landmarks.

use super::time::Time;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use serde_json::{Value, json};
use trundle_core::{Stamp, Vector2, Vector3};

/// Features over the colour image: a message of the schema `foxglove.ImageAnnotations`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FeatureMarks {
    circles: [(); 0],
    texts: [(); 0],
    points: Vec<Value>,
}

impl FeatureMarks {
    /// The name of its schema.
    pub const SCHEMA: &str = "foxglove.ImageAnnotations";

    /// Features at raw pixels: green where they were matched with landmarks, yellow where not.
    pub fn new(stamp: Stamp, features: impl IntoIterator<Item = (Vector2, bool)>) -> Self {
        let (tracked, rest): (Vec<_>, Vec<_>) = features.into_iter().partition(|(_, tracked)| *tracked);
        let group = |marks: Vec<(Vector2, bool)>, color: Value| {
            let points: Vec<Value> = marks.iter().map(|(p, _)| json!({"x": p.x, "y": p.y})).collect();
            json!({
                "timestamp": Time::from(stamp), "type": POINTS_TYPE, "points": points, "outline_color": color,
                "outline_colors": [], "fill_color": color, "thickness": 3.0,
            })
        };
        let points = vec![group(rest, color(1.0, 0.8, 0.1, 0.8)), group(tracked, color(0.1, 0.8, 0.3, 1.0))];
        Self { circles: [], texts: [], points }
    }
}

/// `PointsAnnotation.Type.POINTS_TYPE`.
const POINTS_TYPE: u8 = 1;
/// `LinePrimitive.Type.LINE_LIST`.
const LINE_LIST: u8 = 2;

/// Landmarks: a message of the schema `foxglove.PointCloud`, three `f32` a point.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LandmarkCloud {
    timestamp: Time,
    frame_id: String,
    pose: Value,
    point_stride: u32,
    fields: Value,
    data: String,
}

impl LandmarkCloud {
    /// The name of its schema.
    pub const SCHEMA: &str = "foxglove.PointCloud";

    /// Points of the frame `frame_id`, m.
    pub fn new(stamp: Stamp, frame_id: &str, points: impl IntoIterator<Item = Vector3>) -> Self {
        let bytes = |p: Vector3| [p.x, p.y, p.z].into_iter().flat_map(|v| (v as f32).to_le_bytes());
        let data: Vec<u8> = points.into_iter().flat_map(bytes).collect();
        let field = |(i, name)| json!({"name": name, "offset": 4 * i, "type": FLOAT32_TYPE});
        let fields = ["x", "y", "z"].into_iter().enumerate().map(field).collect();
        Self {
            timestamp: stamp.into(),
            frame_id: frame_id.to_owned(),
            pose: identity(),
            point_stride: 12,
            fields,
            data: STANDARD.encode(data),
        }
    }
}

/// `PackedElementField.NumericType.FLOAT32_TYPE`.
const FLOAT32_TYPE: u8 = 7;

/// Links between keyframes: a message of the schema `foxglove.SceneUpdate` with the covisibility graph and the closed
/// loops as lines.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KeyframeGraph {
    deletions: [(); 0],
    entities: Vec<Value>,
}

impl KeyframeGraph {
    /// The name of its schema.
    pub const SCHEMA: &str = "foxglove.SceneUpdate";

    /// Pairs of keyframe positions in the frame `frame_id`, m. A later message replaces an earlier one.
    pub fn new(
        stamp: Stamp,
        frame_id: &str,
        covisible: impl IntoIterator<Item = (Vector3, Vector3)>,
        loops: impl IntoIterator<Item = (Vector3, Vector3)>,
    ) -> Self {
        let entity = |id: &str, lines: Value| {
            json!({
                "timestamp": Time::from(stamp), "frame_id": frame_id, "id": id, "lifetime": {"sec": 0, "nsec": 0},
                "frame_locked": false, "metadata": [], "arrows": [], "cubes": [], "spheres": [], "cylinders": [],
                "lines": [lines], "triangles": [], "texts": [], "models": [],
            })
        };
        let covisible = lines(covisible, 1.0, color(0.3, 0.7, 1.0, 0.5));
        let loops = lines(loops, 3.0, color(0.9, 0.3, 0.1, 1.0));
        Self { deletions: [], entities: vec![entity("covisibility", covisible), entity("loops", loops)] }
    }
}

fn lines(pairs: impl IntoIterator<Item = (Vector3, Vector3)>, thickness: f64, color: Value) -> Value {
    let points: Vec<Value> = pairs.into_iter().flat_map(|(a, b)| [xyz(a), xyz(b)]).collect();
    json!({
        "type": LINE_LIST, "pose": identity(), "thickness": thickness, "scale_invariant": true, "points": points,
        "color": color, "colors": [], "indices": [],
    })
}

fn xyz(p: Vector3) -> Value {
    json!({"x": p.x, "y": p.y, "z": p.z})
}

fn color(r: f64, g: f64, b: f64, a: f64) -> Value {
    json!({"r": r, "g": g, "b": b, "a": a})
}

fn identity() -> Value {
    json!({"position": xyz(Vector3::zeros()), "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}})
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_go_by_whether_they_are_tracked() {
        let marks = [(Vector2::new(1.0, 2.0), true), (Vector2::new(3.0, 4.0), false)];
        let message = serde_json::to_value(FeatureMarks::new(Stamp::from_nanos(5), marks)).unwrap();
        assert_eq!(message["points"][0]["points"], json!([{"x": 3.0, "y": 4.0}]));
        assert_eq!(message["points"][1]["points"], json!([{"x": 1.0, "y": 2.0}]));
        assert_eq!(message["points"][1]["timestamp"], json!({"sec": 0, "nsec": 5}));
    }

    #[test]
    fn landmarks_are_packed_floats() {
        let cloud = LandmarkCloud::new(Stamp::default(), "visual", [Vector3::new(1.0, 0.0, -2.0)]);
        let bytes = STANDARD.decode(&cloud.data).unwrap();
        assert_eq!(bytes.len(), cloud.point_stride as usize);
        assert_eq!(bytes[8..], (-2.0_f32).to_le_bytes());
    }

    #[test]
    fn a_graph_is_a_list_of_lines() {
        let pair = (Vector3::zeros(), Vector3::x());
        let message = KeyframeGraph::new(Stamp::default(), "visual", [pair, pair], [pair]);
        let message = serde_json::to_value(message).unwrap();
        assert_eq!(message["entities"][0]["lines"][0]["points"].as_array().unwrap().len(), 4);
        assert_eq!(message["entities"][1]["id"], "loops");
    }
}

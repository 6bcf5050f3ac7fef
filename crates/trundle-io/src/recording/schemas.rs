//! JSON Schemas of what trundle records. Those named `foxglove.*` are the well-known ones of Foxglove, in their
//! required parts; those named `trundle.*` are ours.

/// The schema of that name; any object for unknown names.
pub(super) fn json_schema(name: &str) -> String {
    let properties = match name {
        "foxglove.PoseInFrame" => fields(&[TIMESTAMP, FRAME_ID, ("pose", POSE)]),
        "foxglove.PosesInFrame" => {
            fields(&[TIMESTAMP, FRAME_ID, ("poses", &format!(r#"{{"type":"array","items":{POSE}}}"#))])
        }
        "foxglove.PointCloud" => fields(&[
            TIMESTAMP,
            FRAME_ID,
            ("pose", POSE),
            ("point_stride", r#"{"type":"integer","minimum":0}"#),
            ("fields", OBJECTS),
            ("data", BYTES),
        ]),
        "foxglove.ImageAnnotations" => {
            fields(&[("circles", OBJECTS), ("points", OBJECTS), ("texts", OBJECTS)])
        }
        "foxglove.SceneUpdate" => fields(&[("deletions", OBJECTS), ("entities", OBJECTS)]),
        "trundle.WheelTicks" => fields(&[STAMP, ("left", COUNTER), ("right", COUNTER)]),
        "trundle.GyroRate" => fields(&[STAMP, ("omega_rad_s", NUMBER)]),
        "trundle.Touch" => fields(&[STAMP, ("pressed", r#"{"type":"boolean"}"#)]),
        "trundle.Cliff" => fields(&[STAMP, ("over_edge", r#"{"type":"boolean"}"#)]),
        "trundle.Odometry" => fields(&[
            STAMP,
            ("x_m", NUMBER),
            ("y_m", NUMBER),
            ("theta_rad", NUMBER),
            ("v_m_s", NUMBER),
            ("omega_rad_s", NUMBER),
            ("covariance", r#"{"type":"array","items":{"type":"array","items":{"type":"number"}}}"#),
        ]),
        "trundle.BodyEvent" => {
            fields(&[STAMP, ("event", r#"{"oneOf":[{"type":"string"},{"type":"object"}]}"#)])
        }
        "trundle.Scan" => fields(&[
            STAMP,
            ("origin_m", NUMBERS),
            ("angle_min_rad", NUMBER),
            ("angle_increment_rad", NUMBER),
            ("ranges_m", r#"{"type":"array","items":{"type":["number","null"]}}"#),
            ("hits", r#"{"type":"array","items":{"type":"boolean"}}"#),
        ]),
        "trundle.Mark" => fields(&[("mark", r#"{"oneOf":[{"type":"string"},{"type":"object"}]}"#)]),
        "trundle.Twist" => fields(&[("v", NUMBER), ("omega", NUMBER)]),
        "trundle.Goal" => fields(&[("x", NUMBER), ("y", NUMBER), ("theta", NUMBER)]),
        _ => fields(&[]),
    };
    format!(r#"{{"title":"{}","type":"object","properties":{{{properties}}}}}"#, name.escape_default())
}

const TIMESTAMP: (&str, &str) = ("timestamp", TIME);
const STAMP: (&str, &str) = ("stamp", TIME);
const FRAME_ID: (&str, &str) = ("frame_id", STRING);

const STRING: &str = r#"{"type":"string"}"#;
const NUMBER: &str = r#"{"type":"number"}"#;
const OBJECTS: &str = r#"{"type":"array","items":{"type":"object"}}"#;
const NUMBERS: &str = r#"{"type":"array","items":{"type":"number"}}"#;
const COUNTER: &str = r#"{"type":"integer","minimum":0,"maximum":65535}"#;
const BYTES: &str = r#"{"type":"string","contentEncoding":"base64"}"#;
const TIME: &str = r#"{"type":"object","title":"time","properties":{"sec":{"type":"integer","minimum":0},"nsec":{"type":"integer","minimum":0,"maximum":999999999}}}"#;
const POSE: &str = r#"{"title":"foxglove.Pose","type":"object","properties":{"position":{"title":"foxglove.Vector3","type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},"orientation":{"title":"foxglove.Quaternion","type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}}}}"#;

fn fields(properties: &[(&str, &str)]) -> String {
    let pairs: Vec<_> = properties.iter().map(|(name, schema)| format!(r#""{name}":{schema}"#)).collect();
    pairs.join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_schema_is_json() {
        for name in [
            "foxglove.PoseInFrame",
            "foxglove.PosesInFrame",
            "foxglove.PointCloud",
            "foxglove.ImageAnnotations",
            "foxglove.SceneUpdate",
            "trundle.WheelTicks",
            "trundle.GyroRate",
            "trundle.Touch",
            "trundle.Cliff",
            "trundle.Odometry",
            "trundle.BodyEvent",
            "trundle.Scan",
            "trundle.Twist",
            "trundle.Goal",
            "trundle.Config",
            "any \"thing\"",
        ] {
            let schema: serde_json::Value = serde_json::from_str(&json_schema(name)).unwrap();
            assert_eq!((&schema["title"], &schema["type"]), (&name.into(), &"object".into()));
        }
    }
}

//! Zones and named places of a map: a GeoJSON file.

use super::degrees_hint;
use crate::excerpt::excerpt;
use crate::files::read_text;
use crate::{Expected, IoError};
use serde_json::{Value, json};
use std::path::Path;
use trundle_core::{MapAnnotations, NamedPlace, Pose2, Zone, ZoneKind};

/// Zones and named places of a map, from a GeoJSON file (RFC 7946) with coordinates of the map frame in m.
///
/// Each feature has a whole number as `id`, and in `properties` a `kind` and a `name`. A zone is a `Polygon` of one ring; its kind is
/// `no_go`, `slow` (with `speed_m_s`) or `area`. A place is a `Point` of kind `place`, with `heading_deg`. Other properties are refused,
/// because each change rewrites the file.
///
/// ```json
/// {"type": "FeatureCollection", "features": [
///   {"type": "Feature", "id": 1, "properties": {"kind": "slow", "name": "ramp", "speed_m_s": 0.2},
///    "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [2, 0], [2, 1], [0, 0]]]}},
///   {"type": "Feature", "id": 2, "properties": {"kind": "place", "name": "desk", "heading_deg": 90},
///    "geometry": {"type": "Point", "coordinates": [1.2, 0.5]}}]}
/// ```
///
/// # Errors
/// When the file cannot be read, is no such JSON, or a zone or place is invalid. Names the feature.
pub fn read_annotations(path: &Path) -> Result<MapAnnotations, IoError> {
    Expected::Annotations.check(path)?;
    parse_annotations(path, &read_text(path)?)
}

/// Zones and places from the text of a file of [`read_annotations`]; `path` it has, for errors.
///
/// # Errors
/// As [`read_annotations`], without those of reading.
pub fn parse_annotations(path: &Path, text: &str) -> Result<MapAnnotations, IoError> {
    let value: Value = serde_json::from_str(text).map_err(|error| {
        let problem =
            format!("is not JSON at column {}, expected a GeoJSON FeatureCollection", error.column());
        IoError::line(path, error.line().max(1), problem)
    })?;
    let features = value["features"].as_array().filter(|_| value["type"] == "FeatureCollection");
    let features = features.ok_or_else(|| {
        IoError::malformed(path, "expected a GeoJSON FeatureCollection, an object with a list `features`")
    })?;
    let mut annotations = MapAnnotations::default();
    for (i, feature) in features.iter().enumerate() {
        let problem = |problem: String| IoError::malformed(path, format!("feature {}: {problem}", i + 1));
        match annotation(feature).map_err(problem)? {
            Annotation::Zone(zone) => annotations.zones.push(zone),
            Annotation::Place(place) => annotations.places.push(place),
        }
    }
    annotations.validated().map_err(IoError::field(path))
}

/// The text of a file that [`read_annotations`] reads.
#[must_use]
pub fn annotations_text(annotations: &MapAnnotations) -> String {
    let zones = annotations.zones.iter().map(zone_feature);
    let features: Vec<String> = zones
        .chain(annotations.places.iter().map(place_feature))
        .map(|feature| feature.to_string())
        .collect();
    format!("{{\"type\":\"FeatureCollection\",\"features\":[\n{}\n]}}\n", features.join(",\n"))
}

fn zone_feature(zone: &Zone) -> Value {
    let mut properties = json!({"kind": kind_name(zone.kind), "name": zone.name});
    if let ZoneKind::Slow(speed) = zone.kind {
        properties["speed_m_s"] = json!(speed);
    }
    let ring: Vec<_> = zone.outline.iter().chain(zone.outline.first()).collect();
    let geometry = json!({"type": "Polygon", "coordinates": [ring]});
    json!({"type": "Feature", "id": zone.id, "properties": properties, "geometry": geometry})
}

fn place_feature(place: &NamedPlace) -> Value {
    let heading_deg = place.pose.theta.to_degrees();
    let properties = json!({"kind": PLACE_KIND, "name": place.name, "heading_deg": heading_deg});
    let geometry = json!({"type": "Point", "coordinates": [place.pose.x, place.pose.y]});
    json!({"type": "Feature", "id": place.id, "properties": properties, "geometry": geometry})
}

/// The kind of a place.
const PLACE_KIND: &str = "place";

fn kind_name(kind: ZoneKind) -> &'static str {
    match kind {
        ZoneKind::NoGo => "no_go",
        ZoneKind::Slow(_) => "slow",
        ZoneKind::Area => "area",
    }
}

/// Kind of a feature.
enum Annotation {
    Zone(Zone),
    Place(NamedPlace),
}

fn annotation(feature: &Value) -> Result<Annotation, String> {
    let id = feature["id"].as_u64().and_then(|id| u32::try_from(id).ok());
    let id = id.ok_or_else(|| format!("id is {}, expected a whole number", shown(&feature["id"])))?;
    let properties = &feature["properties"];
    let name = properties["name"].as_str();
    let name =
        name.ok_or_else(|| format!("name is {}, expected a text", shown(&properties["name"])))?.to_owned();
    let allowed: &[&str] = match properties["kind"].as_str() {
        Some("no_go" | "area") => &["kind", "name"],
        Some("slow") => &["kind", "name", "speed_m_s"],
        Some(PLACE_KIND) => &["kind", "name", "heading_deg"],
        _ => {
            let kind = shown(&properties["kind"]);
            return Err(format!("kind is {kind}, expected \"no_go\", \"slow\", \"area\" or \"place\""));
        }
    };
    let mut keys = properties.as_object().into_iter().flat_map(|object| object.keys());
    if let Some(unknown) = keys.find(|key| !allowed.contains(&key.as_str())) {
        return Err(format!("unknown property {}, expected {}", excerpt(unknown), allowed.join(", ")));
    }
    let kind = match properties["kind"].as_str() {
        Some("slow") => ZoneKind::Slow(number(properties, "speed_m_s")?),
        Some("no_go") => ZoneKind::NoGo,
        Some("area") => ZoneKind::Area,
        _ => {
            let [x, y] = point(geometry(feature, "Point")?)?;
            let heading = number(properties, "heading_deg")?.to_radians();
            return Ok(Annotation::Place(NamedPlace { id, name, pose: Pose2::new(x, y, heading) }));
        }
    };
    Ok(Annotation::Zone(Zone { id, name, kind, outline: outline(geometry(feature, "Polygon")?)? }))
}

/// The coordinates of a geometry of this type.
fn geometry<'f>(feature: &'f Value, expected: &str) -> Result<&'f Value, String> {
    let geometry = &feature["geometry"];
    if geometry["type"] != expected {
        return Err(format!("geometry is {}, expected a {expected}", shown(&geometry["type"])));
    }
    Ok(&geometry["coordinates"])
}

/// The corners of a polygon: its ring without the last point, which is the first again.
fn outline(coordinates: &Value) -> Result<Vec<[f64; 2]>, String> {
    let rings = coordinates.as_array().map_or(&[][..], Vec::as_slice);
    let [Value::Array(ring)] = rings else {
        return Err(format!("the polygon has {} rings, expected one: a zone has no holes", rings.len()));
    };
    let mut corners = ring.iter().map(point).collect::<Result<Vec<_>, _>>()?;
    if let Some(problem) = degrees_hint(&corners) {
        return Err(problem);
    }
    if corners.len() < 4 || corners.first() != corners.last() {
        return Err("the ring of the polygon is open, expected the first point again at its end".to_owned());
    }
    corners.pop();
    Ok(corners)
}

fn point(value: &Value) -> Result<[f64; 2], String> {
    let coordinates = value.as_array().map_or(&[][..], Vec::as_slice);
    let numbers: Vec<Option<f64>> = coordinates.iter().map(Value::as_f64).collect();
    match numbers[..] {
        [Some(x), Some(y)] => Ok([x, y]),
        [Some(_), Some(_), Some(_)] => {
            Err(format!("a point is {} with a height, expected [x, y] (m): the map is flat", shown(value)))
        }
        _ => Err(format!("a point is {}, expected [x, y] (m)", shown(value))),
    }
}

fn number(properties: &Value, name: &str) -> Result<f64, String> {
    let value = &properties[name];
    value.as_f64().ok_or_else(|| format!("{name} is {}, expected a number", shown(value)))
}

fn shown(value: &Value) -> String {
    if value.is_null() { "missing".to_owned() } else { excerpt(&value.to_string()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn annotations() -> MapAnnotations {
        let outline = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.25]];
        let zone = |id, kind, name: &str| Zone { id, name: name.to_owned(), kind, outline: outline.clone() };
        let pose = Pose2::new(1.2, -0.5, std::f64::consts::FRAC_PI_2);
        MapAnnotations {
            zones: vec![
                zone(1, ZoneKind::NoGo, "stairs"),
                zone(2, ZoneKind::Slow(0.2), ""),
                zone(5, ZoneKind::Area, "Küche"),
            ],
            places: vec![NamedPlace { id: 3, name: "desk \"1\"".to_owned(), pose }],
        }
    }

    fn read(text: &str) -> Result<MapAnnotations, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        let name = file.path().display().to_string();
        read_annotations(file.path()).map_err(|error| error.to_string().replace(&name, "z.geojson"))
    }

    #[test]
    fn a_written_file_is_read_back() {
        assert_eq!(read(&annotations_text(&annotations())).unwrap(), annotations());
        assert_eq!(read(&annotations_text(&MapAnnotations::default())).unwrap(), MapAnnotations::default());
    }

    #[test]
    fn errors_name_the_feature_and_what_is_expected() {
        let text = annotations_text(&annotations());
        for (from, to, problem) in [
            ("\"id\":2", "\"id\":-2", "z.geojson: feature 2: id is -2, expected a whole number"),
            (
                "\"id\":2",
                "\"id\":1",
                "z.geojson: id of a zone or place is 1 twice, expected another for each",
            ),
            (
                "\"no_go\"",
                "\"wall\"",
                "z.geojson: feature 1: kind is \"wall\", expected \"no_go\", \"slow\", \"area\" or \"place\"",
            ),
            (
                "\"speed_m_s\":0.2",
                "\"speed_m_s\":20",
                "z.geojson: speed of zone 2 is 20 m/s, expected 0.05 to 10",
            ),
            (",\"speed_m_s\":0.2", "", "z.geojson: feature 2: speed_m_s is missing, expected a number"),
            (
                "\"heading_deg\"",
                "\"heading\"",
                "z.geojson: feature 4: unknown property heading, expected kind, name, heading_deg",
            ),
            (
                "\"Point\"",
                "\"LineString\"",
                "z.geojson: feature 4: geometry is \"LineString\", expected a Point",
            ),
            (
                "[2.0,0.0]",
                "[2.0,0.0,0.5]",
                "z.geojson: feature 1: a point is [2.0,0.0,0.5] with a height, expected [x, y] (m): the map is flat",
            ),
            (
                "[[0.0,0.0],[2.0,0.0],[2.0,1.25],[0.0,0.0]]",
                "[[8.54,47.37],[8.5401,47.37],[8.5401,47.3701],[8.54,47.37]]",
                "z.geojson: feature 1: all points lie within 0.1 mm: are they longitude and latitude in degrees? expected x and y of the map in m",
            ),
            (
                ",[0.0,0.0]]]",
                "]]",
                "z.geojson: feature 1: the ring of the polygon is open, expected the first point again at its end",
            ),
        ] {
            assert!(text.contains(from), "{from}");
            assert_eq!(read(&text.replacen(from, to, 1)).unwrap_err(), problem);
        }
        assert!(read("{\"type\": \"FeatureCollection\"}").unwrap_err().contains("expected a GeoJSON"));
        assert!(read("{\n\"features\": [,]}").unwrap_err().starts_with("z.geojson, line 2: is not JSON"));
        let empty = read("").unwrap_err();
        assert!(empty.contains("expected a GeoJSON file of zones and places"), "{empty}");
        assert!(read("[]").is_err() && read("{\"features\": 3}").is_err());
    }
}

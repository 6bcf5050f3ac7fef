//! Way-point graphs: GeoJSON as Nav2's route server reads it.

use crate::excerpt::excerpt;
use crate::files::read_text;
use crate::{Expected, IoError};
use serde::Deserialize;
use serde_json::Value;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use trundle_core::{Vector2, require_in};

/// A way-point graph of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct GraphFile {
    /// Positions of the nodes, map frame, m; in the order of the file.
    pub nodes: Vec<Vector2>,
    /// Lanes, driven from the first node to the second: places in `nodes`.
    pub lanes: Vec<(usize, usize)>,
    /// Features that are neither, by kind, with their number.
    pub left: BTreeMap<String, usize>,
}

#[derive(Deserialize)]
struct Collection {
    features: Vec<Feature>,
}

/// A feature of GeoJSON (RFC 7946); a value that is not an object is skipped.
#[derive(Deserialize)]
struct Feature {
    #[serde(default)]
    id: Value,
    #[serde(default)]
    properties: Value,
    #[serde(default)]
    geometry: Value,
}

/// Role of a feature in a graph.
enum Role {
    Node(String),
    Lane(String),
    /// Ignored: its kind.
    Other(String),
}

impl Feature {
    fn kind(&self) -> &str {
        self.geometry["type"].as_str().unwrap_or("without geometry")
    }

    /// The id as text, so 7, 7.0 and "7" are equal; the feature's own id if its properties have none.
    fn id(&self) -> Option<String> {
        id_text(&self.properties["id"]).or_else(|| id_text(&self.id))
    }

    fn role(&self) -> Role {
        let ends = ["startid", "endid"].map(|name| !self.properties[name].is_null());
        match (self.kind(), self.id()) {
            ("Point", Some(id)) => Role::Node(id),
            ("Point", None) => Role::Other(POINT_WITHOUT_ID.to_owned()),
            ("MultiLineString" | "LineString", id) if ends.contains(&true) => {
                Role::Lane(id.unwrap_or_else(|| "without id".to_owned()))
            }
            (kind @ ("MultiLineString" | "LineString"), _) => {
                Role::Other(format!("{kind} without startid and endid"))
            }
            (kind, _) => Role::Other(kind.chars().take(MAX_KIND_CHARS).collect()),
        }
    }
}

/// Kind of a Point that is no node.
const POINT_WITHOUT_ID: &str = "Point without id";

/// Maximum length of a kind's name, in characters; the rest is cut. Source: ours.
const MAX_KIND_CHARS: usize = 40;

fn id_text(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => {
            let whole =
                number.as_f64().filter(|x| x.fract() == 0.0 && x.abs() < 1e15 && number.as_i64().is_none());
            Some(whole.map_or_else(|| number.to_string(), |x| format!("{x:.0}")))
        }
        _ => None,
    }
}

/// A way-point graph from a GeoJSON file in the form of Nav2's route server.
///
/// A `Point` feature with an id (in `properties`, or its own) is a node. Its coordinates are `[x, y]` or `[x, y, height]` in m;
/// `properties.frame`, if given, is `map`. A `MultiLineString` (or `LineString`) feature with `properties.startid` and `endid` is a
/// straight one-way lane; two lanes give both directions. Ids are numbers or texts. Other properties (costs, operations) and other features
/// are ignored; [`GraphFile::left`] counts these features.
///
/// # Errors
/// When the file cannot be read or is no such JSON, has no node, repeats an id, a lane ends at no node, coordinates are not finite numbers,
/// or a frame is not `map`.
pub fn read_graph(path: &Path) -> Result<GraphFile, IoError> {
    Expected::Graph.check(path)?;
    let text = read_text(path)?;
    let collection: Collection = serde_json::from_str(&text).map_err(|error| refused(path, &error))?;
    let (mut nodes, mut places, mut lanes) = (Vec::new(), HashMap::new(), Vec::new());
    let mut left = BTreeMap::new();
    for feature in &collection.features {
        match feature.role() {
            Role::Node(id) => {
                if places.insert(id.clone(), nodes.len()).is_some() {
                    return Err(IoError::malformed(path, format!("node {id} comes twice")));
                }
                nodes.push(node(path, &id, feature)?);
            }
            Role::Lane(id) => lanes.push((id, &feature.properties)),
            Role::Other(kind) => *left.entry(kind).or_insert(0) += 1,
        }
    }
    if nodes.is_empty() {
        return Err(IoError::malformed(path, no_node(collection.features.len(), left.get(POINT_WITHOUT_ID))));
    }
    let lanes = lanes.iter().map(|(id, properties)| lane(path, id, properties, &places));
    Ok(GraphFile { lanes: lanes.collect::<Result<_, _>>()?, nodes, left })
}

/// The problem of a file with this number of features, none of which is a node.
fn no_node(features: usize, points_without_id: Option<&usize>) -> String {
    let cause = match points_without_id {
        _ if features == 0 => "the list `features` is empty".to_owned(),
        Some(count) => format!("{count} Points have no id"),
        None => "no feature is a Point".to_owned(),
    };
    format!("there is no node: {cause}, expected Points with a number or text `id`")
}

fn refused(path: &Path, error: &serde_json::Error) -> IoError {
    let (line, column) = (error.line(), error.column());
    let problem = if error.is_eof() {
        "the file ends in the middle, expected a whole GeoJSON FeatureCollection".to_owned()
    } else if error.is_data() {
        "expected a GeoJSON FeatureCollection, an object with a list `features` of objects".to_owned()
    } else {
        format!("is not JSON at column {column}, expected a GeoJSON FeatureCollection")
    };
    IoError::line(path, line.max(1), problem)
}

fn node(path: &Path, id: &str, feature: &Feature) -> Result<Vector2, IoError> {
    let frame = feature.properties["frame"].as_str();
    if let Some(frame) = frame.filter(|frame| !matches!(*frame, "map" | "")) {
        return Err(IoError::malformed(path, format!("node {id} is in frame '{frame}', expected 'map'")));
    }
    let found = &feature.geometry["coordinates"];
    let coordinates = found.as_array().map_or(&[][..], Vec::as_slice);
    let numbers: Vec<Option<f64>> = coordinates.iter().map(Value::as_f64).collect();
    let ([Some(x), Some(y)] | [Some(x), Some(y), Some(_)]) = numbers[..] else {
        let found = excerpt(&found.to_string());
        let problem = format!("node {id} is at {found}, expected [x, y] or [x, y, height] (m)");
        return Err(IoError::malformed(path, problem));
    };
    for (axis, value) in [("x", x), ("y", y)] {
        require_in(&format!("node {id} {axis}"), value, "m", -1e6, 1e6).map_err(IoError::field(path))?;
    }
    Ok(Vector2::new(x, y))
}

fn lane(
    path: &Path,
    id: &str,
    properties: &Value,
    places: &HashMap<String, usize>,
) -> Result<(usize, usize), IoError> {
    let end = |name: &str| {
        let node = id_text(&properties[name]);
        let node = node.ok_or_else(|| IoError::malformed(path, format!("lane {id} has no {name}")))?;
        let place = places.get(&node).copied();
        place.ok_or_else(|| {
            IoError::malformed(path, format!("{name} of lane {id} is {node}, which is not a node"))
        })
    };
    Ok((end("startid")?, end("endid")?))
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRAPH: &str = r#"{"type": "FeatureCollection", "name": "graph", "date_generated": "now", "features": [
{"type": "Feature", "properties": {"id": 5, "frame": "map", "metadata": {"class": "living_room"}}, "geometry": {"type": "Point", "coordinates": [1.0, 2.5]}},
{"type": "Feature", "properties": {"id": 9}, "geometry": {"type": "Point", "coordinates": [-3, 2]}},
{"type": "Feature", "properties": {"id": 10, "startid": 5, "endid": 9, "cost": 2.0, "overridable": false},
 "geometry": {"type": "MultiLineString", "coordinates": [[[1.0, 2.5], [-3.0, 2.0]]]}}]}"#;

    fn read(text: &str) -> Result<GraphFile, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        let name = file.path().display().to_string();
        read_graph(file.path()).map_err(|error| error.to_string().replace(&name, "g.geojson"))
    }

    #[test]
    fn nodes_and_lanes_are_those_of_the_route_server() {
        let graph = read(GRAPH).unwrap();
        assert_eq!(graph.nodes, [Vector2::new(1.0, 2.5), Vector2::new(-3.0, 2.0)]);
        assert_eq!(graph.lanes, [(0, 1)]);
    }

    #[test]
    fn errors_name_node_and_lane() {
        for (from, to, problem) in [
            ("\"id\": 9}", "\"id\": 5}", "g.geojson: node 5 comes twice"),
            ("\"endid\": 9", "\"endid\": 7", "g.geojson: endid of lane 10 is 7, which is not a node"),
            ("\"startid\": 5, ", "", "g.geojson: lane 10 has no startid"),
            (
                "\"frame\": \"map\"",
                "\"frame\": \"wgs84\"",
                "g.geojson: node 5 is in frame 'wgs84', expected 'map'",
            ),
            (
                "[-3, 2]",
                "[-3, 2, null]",
                "g.geojson: node 9 is at [-3,2,null], expected [x, y] or [x, y, height] (m)",
            ),
            ("[-3, 2]", "[-3e9, 2]", "g.geojson: node 9 x is -3000000000 m, expected -1000000 to 1000000"),
        ] {
            assert_eq!(read(&GRAPH.replace(from, to)).unwrap_err(), problem);
        }
        assert_eq!(
            read(r#"{"features": []}"#).unwrap_err(),
            "g.geojson: there is no node: the list `features` is empty, expected Points with a number or text `id`"
        );
        let without_id = read(&GRAPH.replace("\"id\"", "\"number\"")).unwrap_err();
        assert!(without_id.contains("there is no node: 2 Points have no id, expected"), "{without_id}");
        assert!(read("{\n\"features\": 3}").unwrap_err().starts_with("g.geojson, line 2: "));
        assert!(read("").is_err() && read("[]").is_err());
        let broken = read("{\n\"features\": [,]}").unwrap_err();
        assert_eq!(
            broken,
            "g.geojson, line 2: is not JSON at column 14, expected a GeoJSON FeatureCollection"
        );
    }

    #[test]
    fn heights_and_texts_as_ids_are_taken() {
        let graph = read(GRAPH).unwrap();
        for (from, to) in [
            ("[-3, 2]", "[-3, 2, 0.5]"),
            ("\"id\": 9}", "\"id\": \"9\"}"),
            ("\"endid\": 9", "\"endid\": \"9\""),
            ("\"endid\": 9", "\"endid\": 9.0"),
            ("\"properties\": {\"id\": 9}", "\"id\": 9, \"properties\": null"),
        ] {
            assert_eq!(read(&GRAPH.replace(from, to)).unwrap(), graph, "{to}");
        }
        let names =
            GRAPH.replace("\"id\": 9}", "\"id\": \"dock\"}").replace("\"endid\": 9", "\"endid\": \"dock\"");
        assert_eq!(read(&names).unwrap(), graph);
    }

    #[test]
    fn other_features_are_left_alone_and_counted() {
        let others = r#"{"type": "Feature", "properties": {"name": "hall"}, "geometry": {"type": "Polygon", "coordinates": [[]]}},
{"type": "Feature", "properties": null, "geometry": null},
{"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [0, 0]}},
{"type": "Feature", "properties": {"id": 3}, "geometry": {"type": "LineString", "coordinates": [[0, 0], [1, 1]]}},
{"type": "Feature", "properties": {"id": 5"#;
        let graph =
            read(&GRAPH.replacen(r#"{"type": "Feature", "properties": {"id": 5"#, others, 1)).unwrap();
        assert_eq!((graph.nodes.len(), graph.lanes.len()), (2, 1));
        let left: Vec<_> = graph.left.iter().map(|(kind, count)| format!("{kind}: {count}")).collect();
        let kinds =
            ["LineString without startid and endid", "Point without id", "Polygon", "without geometry"];
        assert_eq!(left, kinds.map(|kind| format!("{kind}: 1")));
    }
}

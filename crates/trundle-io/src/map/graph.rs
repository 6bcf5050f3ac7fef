//! Way-point graphs: GeoJSON as Nav2's route server reads it.

use crate::IoError;
use crate::files::read_text;
use serde::Deserialize;
use std::collections::HashMap;
use std::path::Path;
use trundle_core::{Vector2, require_in};

/// A way-point graph of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct GraphFile {
    /// Where the nodes are, map frame, m; in the order of the file.
    pub nodes: Vec<Vector2>,
    /// Lanes, driven from the first node to the second: places in `nodes`.
    pub lanes: Vec<(usize, usize)>,
}

#[derive(Deserialize)]
struct Collection {
    features: Vec<Feature>,
}

#[derive(Deserialize)]
struct Feature {
    properties: Properties,
    geometry: Geometry,
}

#[derive(Deserialize)]
struct Properties {
    id: u64,
    frame: Option<String>,
    startid: Option<u64>,
    endid: Option<u64>,
}

#[derive(Deserialize)]
struct Geometry {
    #[serde(rename = "type")]
    kind: String,
    coordinates: serde_json::Value,
}

impl Feature {
    fn is_node(&self) -> bool {
        self.geometry.kind == "Point"
    }

    fn is_lane(&self) -> bool {
        matches!(self.geometry.kind.as_str(), "MultiLineString" | "LineString")
    }
}

/// A way-point graph from a GeoJSON file in the form of Nav2's route server.
///
/// A `Point` feature with `properties.id` is a node, its coordinates `[x, y]` in m, `properties.frame`, if any, `map`. A
/// `MultiLineString` (or `LineString`) feature with `properties.startid` and `endid` is a lane, driven that way only and
/// straight; two lanes make both ways. Other properties (costs, operations) are left alone.
///
/// # Errors
/// When the file cannot be read or is no such JSON, has no node, an id comes twice, a lane ends at no node, coordinates are not
/// two finite numbers, or a frame is not `map`.
pub fn read_graph(path: &Path) -> Result<GraphFile, IoError> {
    let text = read_text(path)?;
    let collection: Collection =
        serde_json::from_str(&text).map_err(|error| IoError::line(path, error.line(), error.to_string()))?;
    let (mut nodes, mut places) = (Vec::new(), HashMap::new());
    for feature in collection.features.iter().filter(|feature| feature.is_node()) {
        let id = feature.properties.id;
        if places.insert(id, nodes.len()).is_some() {
            return Err(IoError::malformed(path, format!("node {id} comes twice")));
        }
        nodes.push(node(path, feature)?);
    }
    if nodes.is_empty() {
        return Err(IoError::malformed(path, "there is no node: no feature is a Point"));
    }
    let lanes = collection.features.iter().filter(|feature| feature.is_lane());
    let lanes = lanes.map(|feature| lane(path, &feature.properties, &places));
    Ok(GraphFile { nodes, lanes: lanes.collect::<Result<_, _>>()? })
}

fn node(path: &Path, feature: &Feature) -> Result<Vector2, IoError> {
    let Properties { id, frame, .. } = &feature.properties;
    if let Some(frame) = frame.as_deref().filter(|frame| *frame != "map") {
        return Err(IoError::malformed(path, format!("node {id} is in frame '{frame}', expected 'map'")));
    }
    let coordinates = feature.geometry.coordinates.as_array().map_or(&[][..], Vec::as_slice);
    let [Some(x), Some(y)] = coordinates.iter().map(serde_json::Value::as_f64).collect::<Vec<_>>()[..] else {
        let found = &feature.geometry.coordinates;
        return Err(IoError::malformed(path, format!("node {id} is at {found}, expected [x, y] (m)")));
    };
    for (axis, value) in [("x", x), ("y", y)] {
        require_in(&format!("node {id} {axis}"), value, "m", -1e6, 1e6).map_err(IoError::field(path))?;
    }
    Ok(Vector2::new(x, y))
}

fn lane(
    path: &Path,
    properties: &Properties,
    places: &HashMap<u64, usize>,
) -> Result<(usize, usize), IoError> {
    let id = properties.id;
    let end = |name: &str, node: Option<u64>| {
        let node = node.ok_or_else(|| IoError::malformed(path, format!("lane {id} has no {name}")))?;
        let place = places.get(&node).copied();
        place.ok_or_else(|| {
            IoError::malformed(path, format!("{name} of lane {id} is {node}, which is no node"))
        })
    };
    Ok((end("startid", properties.startid)?, end("endid", properties.endid)?))
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
            ("\"endid\": 9", "\"endid\": 7", "g.geojson: endid of lane 10 is 7, which is no node"),
            ("\"startid\": 5, ", "", "g.geojson: lane 10 has no startid"),
            (
                "\"frame\": \"map\"",
                "\"frame\": \"wgs84\"",
                "g.geojson: node 5 is in frame 'wgs84', expected 'map'",
            ),
            ("[-3, 2]", "[-3, 2, 1]", "g.geojson: node 9 is at [-3,2,1], expected [x, y] (m)"),
            ("[-3, 2]", "[-3e9, 2]", "g.geojson: node 9 x is -3000000000 m, expected -1000000 to 1000000"),
        ] {
            assert_eq!(read(&GRAPH.replace(from, to)).unwrap_err(), problem);
        }
        assert_eq!(
            read(r#"{"features": []}"#).unwrap_err(),
            "g.geojson: there is no node: no feature is a Point"
        );
        assert!(read("{\n\"features\": 3}").unwrap_err().starts_with("g.geojson, line 2: "));
        assert!(read("").is_err() && read("[]").is_err());
    }
}

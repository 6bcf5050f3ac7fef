//! Maps, masks, graphs and places.

use crate::scratch::{with_file, with_files};
use crate::seeds::{MAP_YAML, SMALL_PGM};
use std::path::Path;
use trundle::io::{read_annotations, read_graph, read_keep_out_mask, read_map, read_places, read_speed_mask};

/// The YAML file of a map, with a small picture.
pub fn map_yaml(bytes: &[u8]) {
    with_files(&[("map.yaml", bytes), ("map.pgm", SMALL_PGM)], |folder| all_maps(&folder.join("map.yaml")));
}

/// The picture of a map, with a fixed YAML file.
pub fn map_picture(bytes: &[u8]) {
    let files = [("map.yaml", MAP_YAML.as_bytes()), ("map.pgm", bytes)];
    with_files(&files, |folder| all_maps(&folder.join("map.yaml")));
}

fn all_maps(yaml: &Path) {
    let _ = read_map(yaml);
    let _ = read_keep_out_mask(yaml);
    let _ = read_speed_mask(yaml, 0.7);
}

/// A graph of way-points.
pub fn graph(bytes: &[u8]) {
    let _ = with_file("graph.geojson", bytes, read_graph);
}

/// Named places.
pub fn places(bytes: &[u8]) {
    let _ = with_file("places.toml", bytes, read_places);
    let _ = with_file("zones.geojson", bytes, read_annotations);
}

//! The map of a run as files, during the run.

use trundle_core::{MapAnnotations, OccupancyGrid};
use trundle_io::{annotations_text, map_pgm, map_yaml};

/// Name of the file with zones and places.
pub const ZONES_FILE: &str = "zones.geojson";

/// A file of a map by its name: `map.pgm`, `map.yaml` or `zones.geojson`; `None` for another name.
#[must_use]
pub fn map_file(name: &str, grid: &OccupancyGrid, annotations: &MapAnnotations) -> Option<Vec<u8>> {
    match name {
        "map.pgm" => Some(map_pgm(grid)),
        "map.yaml" => Some(map_yaml(grid, "map.pgm").into_bytes()),
        ZONES_FILE => Some(annotations_text(annotations).into_bytes()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_io::{read_annotations, read_map};

    #[test]
    fn the_files_are_those_of_a_map() {
        let place = tempfile::tempdir().unwrap();
        let grid = OccupancyGrid::from_ascii(0.05, "#.?\n...").unwrap();
        let annotations = MapAnnotations::default();
        for name in ["map.pgm", "map.yaml", "zones.geojson"] {
            std::fs::write(place.path().join(name), map_file(name, &grid, &annotations).unwrap()).unwrap();
        }
        assert_eq!(read_map(&place.path().join("map.yaml")).unwrap(), grid);
        assert_eq!(read_annotations(&place.path().join("zones.geojson")).unwrap(), annotations);
        assert_eq!(map_file("../secret", &grid, &annotations), None);
    }
}

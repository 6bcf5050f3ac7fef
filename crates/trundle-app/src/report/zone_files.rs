//! Zones and places of a run as files: GeoJSON, and Nav2's keep-out and speed masks.

use crate::AppError;
use crate::operator::ZONES_FILE;
use trundle_core::{GridGeometry, MapAnnotations, ZoneKind};
use trundle_io::{OutputFolder, annotations_text, write_map, write_speed_mask};
use trundle_planning::{forbidden_cells, slow_speeds};

/// Writes `zones.geojson`, and over the cells of the map `keepout_mask.yaml` and `speed_mask.yaml` with their pictures. Empty files are
/// left out. `full_speed`: the robot's highest speed \[m/s\].
///
/// # Errors
/// When a file cannot be written.
pub fn write_zones(
    folder: &OutputFolder,
    annotations: &MapAnnotations,
    map: &GridGeometry,
    full_speed: f64,
) -> Result<(), AppError> {
    if annotations.is_empty() {
        return Ok(());
    }
    folder.write(ZONES_FILE, annotations_text(annotations).as_bytes())?;
    let zones = &annotations.zones;
    if zones.iter().any(|zone| zone.kind == ZoneKind::NoGo) {
        write_map(folder, "keepout_mask", &forbidden_cells(*map, zones))?;
    }
    if let Some(speeds) = slow_speeds(map.resolution, zones) {
        let limit = |cell| speeds.limit(map.center(cell));
        write_speed_mask(folder, "speed_mask", map, limit, full_speed)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Cell, Vector2, Zone};
    use trundle_io::{read_annotations, read_keep_out_mask, read_speed_mask};

    #[test]
    fn the_readers_of_nav2_masks_find_the_zones() {
        let place = tempfile::tempdir().unwrap();
        let folder = OutputFolder::create(&place.path().join("run")).unwrap();
        let square = |id, kind, low: f64| {
            let high = low + 1.0;
            let outline = vec![[low, low], [high, low], [high, high], [low, high]];
            Zone { id, name: String::new(), kind, outline }
        };
        let zones = vec![square(1, ZoneKind::NoGo, 0.0), square(2, ZoneKind::Slow(0.14), 1.5)];
        let annotations = MapAnnotations { zones, places: vec![] };
        let map = GridGeometry::new(0.05, Vector2::new(-1.0, -1.0), 80, 80).unwrap();
        write_zones(&folder, &annotations, &map, 0.7).unwrap();
        let folder = folder.commit().unwrap();
        assert_eq!(read_annotations(&folder.join(ZONES_FILE)).unwrap(), annotations);
        let mask = read_keep_out_mask(&folder.join("keepout_mask.yaml")).unwrap();
        let cells = [0.5, -0.5, 2.0].map(|at| mask.forbidden.at(Vector2::repeat(at)));
        assert_eq!((cells, *mask.forbidden.geometry()), ([Cell::Occupied, Cell::Free, Cell::Free], map));
        assert!(mask.costs.iter().all(|cost| *cost == 0));
        let speeds = read_speed_mask(&folder.join("speed_mask.yaml"), 0.7).unwrap();
        let limit = |at: f64| speeds.limits[map.linear(map.cell_at(Vector2::repeat(at)).unwrap())];
        assert!((limit(2.0) - 0.14).abs() < 1e-3 && limit(0.5).is_infinite(), "{}", limit(2.0));
        assert_eq!(speeds.out_of_range, 0);
    }
}

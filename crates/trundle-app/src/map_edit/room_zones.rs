//! Rooms as zones and places, which the live page and missions read.

use std::collections::BTreeMap;
use trundle_core::{MapAnnotations, NamedPlace, Pose2, Vector2, Zone, ZoneKind, shape_points};
use trundle_mapping::map_edit::Room;

/// Number of corners of a room's zone. Source: ours, half of the limit of a zone.
const MAX_CORNERS: usize = 100;
/// Distances from the outline by which its corners may be left out \[m\], one after the other until the outline is a zone. Source: ours; the
/// first is above the diagonal of a cell of 5 cm, so that a wall askew to the grid becomes straight.
const SIMPLIFICATIONS_M: [f64; 5] = [0.075, 0.15, 0.3, 0.6, 1.2];
/// Largest part of a room's area by which its zone may be larger or smaller \[1\]. Source: ours.
const MAX_AREA_CHANGE: f64 = 0.1;

/// For each room a zone without a rule, and a place of its name: that of `places`, else the point farthest from walls with heading 0. Holes
/// are left out. A room whose outline is no valid zone has a place alone, and is logged.
pub fn room_annotations(
    rooms: &[Room],
    names: &[String],
    places: &BTreeMap<String, Pose2>,
) -> MapAnnotations {
    let mut annotations = MapAnnotations::default();
    for (room, name) in rooms.iter().zip(names) {
        let outer = room.rings.first().map_or(&[][..], Vec::as_slice);
        let zone = zone(annotations.free_id(), name, outer);
        if zone.is_none() {
            tracing::warn!("the outline of '{name}' is no zone: it is left out of zones.geojson");
        }
        annotations.zones.extend(zone);
        let pose = places.get(name).copied();
        let pose = pose.unwrap_or_else(|| Pose2::new(room.center.x, room.center.y, 0.0));
        annotations.places.push(NamedPlace { id: annotations.free_id(), name: name.clone(), pose });
    }
    annotations
}

/// The zone of an outer ring; `None` if no outline with few corners is a valid zone of about the same area.
fn zone(id: u32, name: &str, ring: &[Vector2]) -> Option<Zone> {
    let outlined = |ring: &[Vector2]| Zone {
        id,
        name: name.to_owned(),
        kind: ZoneKind::Area,
        outline: ring.iter().map(|p| [p.x, p.y]).collect(),
    };
    let exact = outlined(ring).area();
    SIMPLIFICATIONS_M.iter().find_map(|tolerance| {
        let zone = outlined(&simplified(ring, *tolerance)).validated().ok()?;
        ((zone.area() - exact).abs() <= MAX_AREA_CHANGE * exact).then_some(zone)
    })
}

/// At most [`MAX_CORNERS`] corners of the ring, the others at most `tolerance` m off the outline if that is possible.
fn simplified(ring: &[Vector2], tolerance: f64) -> Vec<Vector2> {
    let closed: Vec<Vector2> = ring.iter().chain(ring.first()).copied().collect();
    let mut kept = shape_points(&closed, MAX_CORNERS + 1, tolerance);
    kept.pop();
    kept.into_iter().map(|corner| closed[corner]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A room of 4 x 3 m whose upper wall is a staircase of cells.
    fn room(name_at: Vector2) -> Room {
        let mut ring = vec![Vector2::new(0.0, 0.0), Vector2::new(4.0, 0.0)];
        for step in 0..40 {
            let (x, y) = (4.0 - 0.1 * f64::from(step), 3.0 - 0.05 * f64::from(step % 2));
            ring.extend([Vector2::new(x, y), Vector2::new(x - 0.1, y)]);
        }
        Room { rings: vec![ring], area_m2: 12.0, center: name_at }
    }

    #[test]
    fn a_room_is_an_area_with_few_corners_and_a_place() {
        let rooms = [room(Vector2::new(2.0, 1.5)), room(Vector2::new(1.0, 1.0))];
        let desk = Pose2::new(3.0, 1.0, 1.5);
        let places = BTreeMap::from([("desk".to_owned(), desk)]);
        let names = ["room 1", "desk"].map(str::to_owned);
        let found = room_annotations(&rooms, &names, &places).validated().unwrap();
        assert_eq!(found.zones.len(), 2);
        let zone = &found.zones[0];
        assert!(zone.outline.len() <= 6 && zone.kind == ZoneKind::Area, "{zone:?}");
        assert_eq!(found.pose_of("room 1"), Some(Pose2::new(2.0, 1.5, 0.0)));
        assert_eq!(found.pose_of("desk"), Some(desk), "the named place, with its heading");
    }

    #[test]
    fn a_square_keeps_its_corners_and_a_line_is_no_zone() {
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| Vector2::new(x, y));
        assert_eq!(simplified(&square, 0.1), square);
        assert!(simplified(&[], 0.1).is_empty());
        let line = Room { rings: vec![square[..2].to_vec()], area_m2: 0.0, center: square[0] };
        let found = room_annotations(&[line], &["line".to_owned()], &BTreeMap::new());
        assert!(found.zones.is_empty() && found.places.len() == 1);
    }
}

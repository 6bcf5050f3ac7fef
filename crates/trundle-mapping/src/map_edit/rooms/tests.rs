//! Rooms of small maps.

use super::*;
use trundle_core::Cell;

/// Two rooms of 3 x 3 m over a corridor of 6.2 x 1.6 m, with doors of `door` m, drawn on cells of 5 cm; a table in the left room.
fn flat(door: f64) -> OccupancyGrid {
    let geometry = GridGeometry::new(0.05, Vector2::zeros(), 130, 102).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Unknown);
    for i in 0..geometry.len() {
        let cell = geometry.cell(i);
        let p = geometry.center(cell);
        let within =
            |low: [f64; 2], high: [f64; 2]| p.x > low[0] && p.x < high[0] && p.y > low[1] && p.y < high[1];
        let is_floor = within([0.1, 0.1], [6.3, 1.7])
            || within([0.1, 1.8], [3.1, 4.8])
            || within([3.3, 1.8], [6.3, 4.8])
            || within([1.0, 1.6], [1.0 + door, 1.9])
            || within([4.5, 1.6], [4.5 + door, 1.9]);
        let is_table = within([1.2, 3.0], [2.0, 3.8]);
        let is_inside = within([0.0, 0.0], [6.4, 4.9]);
        let value = match (is_floor && !is_table, is_inside) {
            (true, _) => Cell::Free,
            (false, true) => Cell::Occupied,
            (false, false) => Cell::Unknown,
        };
        grid.set(cell, value);
    }
    grid
}

#[test]
fn doors_divide_a_flat_and_rooms_are_counted_as_one_reads() {
    let found = map_rooms(&flat(0.9), RoomLimits::default()).unwrap();
    assert_eq!(found.rooms().len(), 3, "{:?}", found.rooms());
    let at = |x, y| found.room_at(Vector2::new(x, y));
    assert_eq!([at(0.5, 4.0), at(5.0, 3.0), at(3.2, 0.9)], [Some(0), Some(1), Some(2)]);
    assert_eq!(at(1.6, 3.4), Some(0), "the table belongs to its room");
    assert_eq!(at(6.45, 1.0), None);
    let areas: Vec<f64> = found.rooms().iter().map(|room| room.area_m2).collect();
    assert!((areas[0] - 9.0).abs() < 0.2 && (areas[2] - 9.92).abs() < 0.3, "{areas:?}");
    for room in found.rooms() {
        let ring = &room.rings[0];
        let sides = ring.iter().zip(ring.iter().cycle().skip(1));
        let area = sides.map(|(a, b)| a.perp(b)).sum::<f64>() / 2.0;
        assert!((area - room.area_m2).abs() < 1e-6, "the ring encloses {area} m2: {room:?}");
        assert_eq!(found.room_at(room.center).map(|i| &found.rooms()[i]), Some(room));
    }
}

#[test]
fn an_opening_wider_than_a_door_joins_rooms() {
    let count = |door, limits| map_rooms(&flat(door), limits).unwrap().rooms().len();
    assert_eq!(count(1.3, RoomLimits::default()), 1);
    assert_eq!(count(1.3, RoomLimits { max_door_m: 1.4, ..RoomLimits::default() }), 3);
}

#[test]
fn maps_without_rooms_and_wrong_limits() {
    let wall = OccupancyGrid::from_ascii(0.05, "###\n###").unwrap();
    assert!(map_rooms(&wall, RoomLimits::default()).unwrap().rooms().is_empty());
    let small = OccupancyGrid::from_ascii(0.05, "###\n#.#\n###").unwrap();
    assert!(map_rooms(&small, RoomLimits::default()).unwrap().rooms().is_empty());
    let limits = RoomLimits { max_door_m: 0.0, ..RoomLimits::default() };
    let refused = map_rooms(&wall, limits).unwrap_err().to_string();
    assert_eq!(refused, "door width is 0 m, expected 0.1 to 10");
}

//! Maps of one flat in frames of their own.

use super::*;
use crate::map_edit::{cropped, rotated};
use trundle_core::{Cell, GridGeometry, Vector2};

/// A flat of `rooms` on cells of 5 cm: boxes of free floor, walls of one cell about them.
fn flat(boxes: &[[f64; 4]]) -> OccupancyGrid {
    let geometry = GridGeometry::new(0.05, Vector2::new(-1.0, -1.0), 260, 220).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Unknown);
    let is_floor =
        |p: Vector2| boxes.iter().any(|[x0, y0, x1, y1]| p.x > *x0 && p.x < *x1 && p.y > *y0 && p.y < *y1);
    for i in 0..geometry.len() {
        let cell = geometry.cell(i);
        let p = geometry.center(cell);
        let near = [(0.05, 0.0), (-0.05, 0.0), (0.0, 0.05), (0.0, -0.05)];
        if is_floor(p) {
            grid.set(cell, Cell::Free);
        } else if near.iter().any(|(x, y)| is_floor(p + Vector2::new(*x, *y))) {
            grid.set(cell, Cell::Occupied);
        }
    }
    grid
}

/// Four rooms of different sizes about a corridor.
fn house() -> OccupancyGrid {
    flat(&[
        [0.0, 3.0, 9.0, 4.5],
        [0.0, 4.6, 3.5, 8.0],
        [1.0, 4.0, 1.9, 5.0],
        [3.6, 4.6, 9.0, 7.2],
        [5.0, 4.0, 5.9, 5.0],
        [0.0, 0.0, 5.2, 2.9],
        [3.0, 2.5, 3.9, 3.5],
        [6.0, 0.8, 9.0, 2.9],
        [7.0, 2.5, 7.9, 3.5],
    ])
}

/// The map in a frame in which its own frame has the pose `moved`.
fn moved(map: &OccupancyGrid, pose: Pose2) -> OccupancyGrid {
    rotated(map, Pose2::new(pose.x, pose.y, 0.0), 0.0)
        .and_then(|map| rotated(&map, Pose2::IDENTITY, pose.theta))
        .unwrap()
}

#[test]
fn a_turned_part_of_a_flat_is_found_to_a_cell() {
    let whole = house();
    for (low, high, turn) in [
        ([-1.0, 2.0], [6.0, 9.0], 37.0),
        ([-1.0, -1.0], [12.0, 10.0], -123.0),
        ([3.0, -1.0], [12.0, 8.0], 180.0),
    ] {
        let part = cropped(&whole, low.into(), high.into()).unwrap();
        let turn = f64::to_radians(turn);
        let other = moved(&part, Pose2::new(4.0, -2.5, turn));
        let found = match_maps(&whole, &other).unwrap();
        // other_from_whole is the turn after the shift.
        let truth = (Pose2::new(0.0, 0.0, turn) * Pose2::new(4.0, -2.5, 0.0)).inverse();
        let error = found.best.first_from_second.inverse() * truth;
        assert!(
            error.position().norm() < 0.06 && error.theta.to_degrees().abs() < 0.4,
            "{error:?} of {found:?}"
        );
        assert!(found.best.agreeing_share() > 0.93, "{found:?}");
    }
}

#[test]
fn a_symmetric_room_and_a_foreign_flat_are_refused() {
    let room = flat(&[[0.0, 0.0, 6.0, 4.0]]);
    let Err(MatchFailure::Ambiguous(found)) = match_maps(&room, &moved(&room, Pose2::new(1.0, 2.0, 0.7)))
    else {
        panic!("two poses of a rectangle fit")
    };
    assert!(found.rival.unwrap().agreeing_share() > 0.9, "{found:?}");
    let other =
        flat(&[[0.0, 0.0, 2.1, 7.0], [2.0, 5.0, 8.0, 7.3], [6.0, 2.0, 7.7, 6.0], [7.0, 2.2, 10.5, 4.0]]);
    let refused = match_maps(&house(), &other);
    assert!(matches!(refused, Err(MatchFailure::NothingFits(_) | MatchFailure::Ambiguous(_))), "{refused:?}");
    let empty = OccupancyGrid::from_ascii(0.05, "....").unwrap();
    assert_eq!(match_maps(&room, &empty), Err(MatchFailure::NoWall(1)));
    assert_eq!(match_maps(&empty, &room), Err(MatchFailure::NoWall(0)));
}

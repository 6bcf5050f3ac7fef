//! Walls, doors and obstacles of resampled maps.

use super::*;
use crate::map_edit::rotated;
use trundle_core::Vector2;

/// A room of `side` cells with walls `thick` cells thick, a door of `door` cells in a wall across its middle, and posts of one cell.
fn house(side: usize, thick: usize, door: usize) -> OccupancyGrid {
    let geometry = GridGeometry::new(0.05, Vector2::new(-1.0, 2.0), side, side).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    let middle = side / 2;
    for row in 0..side {
        for col in 0..side {
            let is_outer = [row, col].iter().any(|at| *at < thick || *at >= side - thick);
            let is_door = (side / 4..side / 4 + door).contains(&row);
            let is_inner = (middle..middle + thick).contains(&col) && !is_door;
            let is_post = row % 15 == 7 && col % 15 == 4 && col.abs_diff(middle) > 5;
            if is_outer || is_inner || is_post {
                grid.set(CellIndex { col, row }, Cell::Occupied);
            }
        }
    }
    grid
}

/// Free cells that are connected with a point by sides of cells.
fn connected(grid: &OccupancyGrid, from: Vector2, clearance: usize) -> Vec<bool> {
    let geometry = grid.geometry();
    let is_clear = |cell: CellIndex| {
        let span = |at: usize, end: usize| at.saturating_sub(clearance)..(at + clearance + 1).min(end);
        span(cell.row, geometry.height).all(|row| {
            span(cell.col, geometry.width).all(|col| grid.get(CellIndex { col, row }) != Cell::Occupied)
        })
    };
    let start = geometry.cell_at(from).unwrap();
    assert!(is_clear(start), "the start is not free");
    let mut reached = vec![false; geometry.len()];
    reached[geometry.linear(start)] = true;
    let mut open = vec![start];
    while let Some(CellIndex { col, row }) = open.pop() {
        let near = [(col + 1, row), (col.wrapping_sub(1), row), (col, row + 1), (col, row.wrapping_sub(1))];
        for (col, row) in near.into_iter().filter(|near| near.0 < geometry.width && near.1 < geometry.height)
        {
            let next = CellIndex { col, row };
            if !reached[geometry.linear(next)] && is_clear(next) {
                reached[geometry.linear(next)] = true;
                open.push(next);
            }
        }
    }
    reached
}

fn occupied(grid: &OccupancyGrid) -> usize {
    grid.cells().iter().filter(|cell| **cell == Cell::Occupied).count()
}

/// The point of a moved map that was at `at`.
fn moved(at: [f64; 2], turn: f64) -> Vector2 {
    Pose2::new(0.0, 0.0, turn).transform(at.into())
}

/// Turns that are tried \[deg\]. Source: ours.
const TURNS_DEG: [f64; 12] = [0.3, 1.0, 5.0, 12.5, 22.5, 30.0, 38.0, 44.9, 45.0, 61.0, 89.5, 133.0];

#[test]
fn walls_stay_closed_at_any_angle_and_keep_their_thickness() {
    for (thick, tolerance) in [(1, 0.22), (2, 0.1), (3, 0.08)] {
        let map = house(90, thick, 0);
        for turn in TURNS_DEG {
            let turned = rotated(&map, Pose2::IDENTITY, turn.to_radians()).unwrap();
            let left = connected(&turned, moved([0.0, 4.0], turn.to_radians()), 0);
            let right = turned.geometry().cell_at(moved([2.5, 4.0], turn.to_radians())).unwrap();
            assert!(
                !left[turned.geometry().linear(right)],
                "the middle wall of {thick} cells opens at {turn} deg"
            );
            let corner = turned.geometry().linear(CellIndex { col: 0, row: 0 });
            assert!(!left[corner], "the outer wall of {thick} cells opens at {turn} deg");
            let ratio = occupied(&turned) as f64 / occupied(&map) as f64;
            assert!(
                (ratio - 1.0).abs() < tolerance,
                "walls of {thick} cells have {ratio} of their area at {turn} deg"
            );
        }
    }
}

#[test]
fn a_door_of_eight_cells_stays_passable_and_no_post_is_lost() {
    let map = house(90, 2, 8);
    for turn in TURNS_DEG {
        let turned = rotated(&map, Pose2::IDENTITY, turn.to_radians()).unwrap();
        // A robot of 7 cells: the door of 8 cells loses one at most.
        let left = connected(&turned, moved([-0.5, 2.5], turn.to_radians()), 2);
        let right = turned.geometry().cell_at(moved([2.4, 2.5], turn.to_radians())).unwrap();
        assert!(left[turned.geometry().linear(right)], "the door closes at {turn} deg");
        let posts = (0..map.geometry().len()).map(|i| map.geometry().cell(i));
        let posts =
            posts.filter(|cell| cell.row % 15 == 7 && cell.col % 15 == 4 && cell.col.abs_diff(45) > 5);
        for post in posts {
            let at = Pose2::new(0.0, 0.0, turn.to_radians()).transform(map.geometry().center(post));
            let cell = turned.geometry().cell_at(at).unwrap();
            let near = |cell: CellIndex| (turned.geometry().center(cell) - at).norm() < 0.06;
            let cells = (cell.row - 1..=cell.row + 1)
                .flat_map(|row| (cell.col - 1..=cell.col + 1).map(move |col| CellIndex { col, row }));
            let found = cells.filter(|cell| turned.get(*cell) == Cell::Occupied && near(*cell)).count();
            assert!((1..=2).contains(&found), "a post has {found} cells at {turn} deg");
        }
    }
}

#[test]
fn a_diagonal_wall_that_touches_at_corners_stays_closed() {
    let geometry = GridGeometry::new(0.05, Vector2::zeros(), 61, 61).unwrap();
    let mut map = OccupancyGrid::filled(geometry, Cell::Free);
    (0..61).for_each(|i| map.set(CellIndex { col: i, row: i }, Cell::Occupied));
    for k in 0..40 {
        // Any position between the new cells.
        let turn = Pose2::new(
            0.013 * f64::from(k),
            0.0071 * f64::from(k),
            (-45.0 - 0.7 * f64::from(k)).to_radians(),
        );
        let target = covering(&map, turn);
        let turned = resampled(&map, turn, target);
        let wall = occupied(&turned);
        assert!((40..=95).contains(&wall), "{wall} cells for 61 that touch at corners");
        let one = turn.transform(Vector2::new(1.0, 2.0));
        let two = target.cell_at(turn.transform(Vector2::new(2.0, 1.0))).unwrap();
        // Unknown cells about the square of the map belong to neither side.
        let mut closed = turned.clone();
        for i in 0..target.len() {
            if turned.cells()[i] == Cell::Unknown {
                closed.set(target.cell(i), Cell::Occupied);
            }
        }
        assert!(!connected(&closed, one, 0)[target.linear(two)], "the wall opens in case {k}");
    }
}

fn covering(map: &OccupancyGrid, pose: Pose2) -> GridGeometry {
    crate::map_edit::covering_lattice(&[(map, pose)], 0.05, Vector2::zeros()).unwrap()
}

#[test]
fn right_angles_and_whole_cells_are_copied() {
    let map = house(30, 1, 4);
    let mut back = map.clone();
    for _ in 0..4 {
        back = rotated(&back, Pose2::IDENTITY, std::f64::consts::FRAC_PI_2).unwrap();
        assert_eq!(occupied(&back), occupied(&map));
    }
    assert_eq!(back.cells(), map.cells());
    assert!((back.geometry().origin - map.geometry().origin).norm() < 1e-9);
    let wide = GridGeometry::new(0.05, Vector2::new(-1.5, 1.5), 60, 60).unwrap();
    let copy = resampled(&map, Pose2::IDENTITY, wide);
    for i in 0..wide.len() {
        let at = wide.center(wide.cell(i));
        assert_eq!(copy.at(at), map.at(at));
    }
}

#[test]
fn thin_walls_survive_larger_cells() {
    let map = house(90, 1, 0);
    for resolution in [0.07, 0.1, 0.15] {
        let geometry =
            crate::map_edit::covering_lattice(&[(&map, Pose2::IDENTITY)], resolution, Vector2::zeros());
        let coarse = resampled(&map, Pose2::IDENTITY, geometry.unwrap());
        let left = connected(&coarse, Vector2::new(-0.2, 4.0), 0);
        let right = coarse.geometry().cell_at(Vector2::new(2.5, 4.0)).unwrap();
        assert!(!left[coarse.geometry().linear(right)], "the wall opens in cells of {resolution} m");
    }
}

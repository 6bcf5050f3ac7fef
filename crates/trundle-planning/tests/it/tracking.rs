//! Movers found in successive grids.

use crate::support::{at_home, found, judge, planner};
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::{Mover, MoverTracker, TrackerConfig};

const PERSON: f64 = 0.25;

fn room() -> OccupancyGrid {
    let geometry = GridGeometry::new(0.05, Vector2::new(-1.0, 0.0), 200, 120).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    for col in 0..200 {
        [0, 119].into_iter().for_each(|row| grid.set(CellIndex { col, row }, Cell::Occupied));
    }
    grid
}

/// The grid with discs on it.
fn with(grid: &OccupancyGrid, discs: &[(Vector2, f64)]) -> OccupancyGrid {
    let mut seen = grid.clone();
    for linear in 0..grid.geometry().len() {
        let cell = grid.geometry().cell(linear);
        let centre = grid.geometry().center(cell);
        if discs.iter().any(|(at, radius)| (centre - at).norm() < *radius) {
            seen.set(cell, Cell::Occupied);
        }
    }
    seen
}

fn tracker() -> MoverTracker {
    MoverTracker::new(TrackerConfig::default()).unwrap()
}

/// Two seconds of looks, five a second, at things that move steadily.
fn watched(tracker: &mut MoverTracker, grid: &OccupancyGrid, things: &[(Vector2, Vector2)]) -> Vec<Mover> {
    let mut last = Vec::new();
    tracker.look(-0.2, grid);
    for k in 0..=10 {
        let time = f64::from(k) * 0.2;
        let discs: Vec<_> = things.iter().map(|(from, v)| (from + v * time, PERSON)).collect();
        last = tracker.look(time, &with(grid, &discs));
    }
    last
}

#[test]
fn two_people_are_found_where_they_are_and_will_be() {
    let at = |x: f64, y: f64| Vector2::new(x, y);
    let things = [(at(0.0, 1.0), at(0.8, 0.2)), (at(6.0, 4.0), at(-0.5, -0.4))];
    let movers = watched(&mut tracker(), &room(), &things);
    assert_eq!(movers.len(), 2, "{movers:?}");
    for (from, v) in things {
        // Where it is, and where it will be in two seconds.
        for (ahead, near) in [(0.0, 0.12), (2.0, 0.3)] {
            let true_place = from + v * (2.0 + ahead);
            let off = movers.iter().map(|m| (m.at(ahead) - true_place).norm()).fold(9.0, f64::min);
            assert!(off < near, "{off} m off {ahead} s ahead: {movers:?}");
        }
    }
}

#[test]
fn what_stands_appears_or_comes_into_view_is_no_mover() {
    let still = (Vector2::new(3.0, 3.0), Vector2::zeros());
    assert!(watched(&mut tracker(), &room(), &[still]).is_empty(), "a box was put down");
    // A wall comes into view column by column, as the robot drives along it.
    let mut grid = OccupancyGrid::filled(*room().geometry(), Cell::Unknown);
    let mut tracker = tracker();
    for k in 0..100 {
        for col in 2 * k..2 * k + 2 {
            (0..120).for_each(|row| {
                let cell = if row % 40 < 2 { Cell::Occupied } else { Cell::Free };
                grid.set(CellIndex { col, row }, cell);
            });
        }
        assert!(tracker.look(k as f64 * 0.1, &grid).is_empty());
    }
    // Cells of a wall that flicker.
    for k in 0..60 {
        let flicker = CellIndex { col: 40 + k % 7, row: 2 };
        let mut seen = grid.clone();
        seen.set(flicker, Cell::Occupied);
        assert!(tracker.look(20.0 + k as f64 * 0.1, &seen).is_empty());
    }
}

#[test]
fn who_stops_is_soon_part_of_the_map() {
    let mut tracker = tracker();
    let walks = (Vector2::new(0.0, 2.0), Vector2::new(0.7, 0.0));
    assert_eq!(watched(&mut tracker, &room(), &[walks]).len(), 1);
    let stands = with(&room(), &[(walks.0 + walks.1 * 2.0, PERSON)]);
    let mut left = 1;
    for k in 1..=20 {
        left = tracker.look(2.0 + f64::from(k) * 0.2, &stands).len();
    }
    assert_eq!(left, 0);
}

#[test]
fn a_grid_that_grows_loses_nobody() {
    let (small, mut tracker) = (room(), tracker());
    let walks = (Vector2::new(1.0, 2.0), Vector2::new(0.7, 0.0));
    watched(&mut tracker, &small, &[walks]);
    let geometry = GridGeometry::new(0.05, Vector2::new(-2.0, -1.0), 260, 160).unwrap();
    let large = OccupancyGrid::filled(geometry, Cell::Free);
    let movers = tracker.look(2.2, &with(&large, &[(walks.0 + walks.1 * 2.2, PERSON)]));
    assert_eq!(movers.len(), 1);
    assert!((movers[0].at(0.0) - (walks.0 + walks.1 * 2.2)).norm() < 0.12);
}

#[test]
fn looks_back_in_time_and_wrong_numbers_change_nothing() {
    let mut tracker = tracker();
    let walks = (Vector2::new(0.0, 2.0), Vector2::new(0.7, 0.0));
    let movers = watched(&mut tracker, &room(), &[walks]);
    let now = with(&room(), &[(walks.0 + walks.1 * 2.0, PERSON)]);
    assert_eq!(tracker.look(1.0, &now), movers);
    assert_eq!(tracker.look(f64::NAN, &now), movers);
    assert!(MoverTracker::new(TrackerConfig { memory: f64::NAN, ..TrackerConfig::default() }).is_err());
    assert!(MoverTracker::new(TrackerConfig { sightings: 1, ..TrackerConfig::default() }).is_err());
}

#[test]
fn someone_seen_to_cross_is_let_pass() {
    let (grid, mut tracker) = (room(), tracker());
    let crosses = (Vector2::new(1.6, 0.5), Vector2::new(0.0, 0.7));
    let movers = watched(&mut tracker, &grid, &[crosses]);
    let seen = with(&grid, &[(crosses.0 + crosses.1 * 2.0, PERSON)]);
    let still = tracker.without_movers(&seen);
    assert_eq!(still, grid, "the floor under a mover is free");
    let (start, goal) = (Pose2::new(0.6, 2.8, 0.0), Pose2::new(4.0, 2.8, 0.0));
    let plan =
        found(planner(at_home(), 0.1755).plan_among(&still, &movers, start, Twist2::new(0.4, 0.0), goal));
    judge(&still, &plan, start, goal, 0.1755);
    assert!(plan.is_continuous);
    let gap = |k: i32| {
        let time = f64::from(k) * 0.01;
        let there = crosses.0 + crosses.1 * (2.0 + time);
        (plan.trajectory.at(time).pose.position() - there).norm() - PERSON - 0.1755
    };
    let least = (0..=200).map(gap).fold(9.0, f64::min);
    assert!(least > -0.02, "{least}");
}

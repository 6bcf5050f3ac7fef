//! A room and scans of it, for tests.

use trundle_core::{Beam, Cell, GridGeometry, OccupancyGrid, Pose2, Scan, Stamp, Vector2};

/// A room of 6 x 4 m with a box in it; its corner at the origin.
pub(crate) fn room() -> OccupancyGrid {
    let geometry = GridGeometry::new(0.05, Vector2::zeros(), 120, 80).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    for k in 0..geometry.len() {
        let cell = geometry.cell(k);
        let is_wall = [0, 119].contains(&cell.col) || [0, 79].contains(&cell.row);
        let is_box = (70..90).contains(&cell.col) && cell.row < 30;
        if is_wall || is_box {
            grid.set(cell, Cell::Occupied);
        }
    }
    grid
}

/// A depth camera's scan of a map from a pose, at a time \[s\]. `hidden`: a person at this range \[m\] in a part of the view.
pub(crate) fn scan_of(grid: &OccupancyGrid, at: Pose2, time: f64, hidden: Option<f64>) -> Scan {
    let beam = |i: i32| {
        let bearing = at.theta + f64::from(i).to_radians();
        let along = |k: u32| f64::from(k) * 0.02;
        let is_there = |range: f64| {
            grid.at(at.position() + Vector2::new(bearing.cos(), bearing.sin()) * range) == Cell::Occupied
        };
        let range = (0..400).map(along).find(|range| is_there(*range)).unwrap_or(8.0);
        let person = hidden.filter(|_| (-10..12).contains(&i));
        Beam::Hit { range: person.map_or(range, |near| range.min(near)) }
    };
    let step = 1_f64.to_radians();
    let beams = (-35..=35).map(beam).collect();
    Scan::new(Stamp::default().after(time), Vector2::zeros(), -35.0 * step, step, beams).unwrap()
}

//! The BARN worlds of ../shared/data/nav as grids: cylinders, one question each.

use std::path::Path;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2, Vector2};

/// Side of a cell, m. Source: ours.
const RESOLUTION: f64 = 0.05;

/// All worlds, in order.
pub fn worlds(data: &Path) -> Vec<OccupancyGrid> {
    let text = std::fs::read_to_string(data.join("barn/obstacles.csv")).unwrap();
    let mut worlds: Vec<(String, OccupancyGrid)> = Vec::new();
    for line in text.lines().skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let number = |i: usize| words[i].parse::<f64>().unwrap();
        if worlds.last().is_none_or(|(name, _)| name != words[0]) {
            let geometry = GridGeometry::new(RESOLUTION, Vector2::new(-5.0, -1.0), 120, 320).unwrap();
            worlds.push((words[0].to_owned(), OccupancyGrid::filled(geometry, Cell::Free)));
        }
        let last = worlds.len() - 1;
        occupy(&mut worlds[last].1, Vector2::new(number(3), number(4)), number(6));
    }
    worlds.into_iter().map(|(_, grid)| grid).collect()
}

/// The question of every world.
pub fn question() -> (Pose2, Pose2) {
    (Pose2::new(-2.0, 3.0, std::f64::consts::FRAC_PI_2), Pose2::new(-2.0, 13.0, std::f64::consts::FRAC_PI_2))
}

/// Occupies the cells whose middle a disc holds.
fn occupy(grid: &mut OccupancyGrid, middle: Vector2, radius: f64) {
    let geometry = *grid.geometry();
    let index =
        |at: f64, size: usize| (at / geometry.resolution).floor().clamp(0.0, size as f64 - 1.0) as usize;
    let (low, high) = (
        middle - geometry.origin - Vector2::repeat(radius),
        middle - geometry.origin + Vector2::repeat(radius),
    );
    for row in index(low.y, geometry.height)..=index(high.y, geometry.height) {
        for col in index(low.x, geometry.width)..=index(high.x, geometry.width) {
            let cell = CellIndex { col, row };
            if (geometry.center(cell) - middle).norm() <= radius {
                grid.set(cell, Cell::Occupied);
            }
        }
    }
}

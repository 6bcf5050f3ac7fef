//! Scenes whose walls are those of an occupancy grid, and the grid as a robot's map.

use trundle_app::AppError;
use trundle_core::{Cell, GridGeometry, Invalid, OccupancyGrid, Pose2, Vector2, Vector3};
use trundle_sim::import::{RaisedMap, raise_map};
use trundle_sim::{Cuboid, Finish, Lights, Paint, Scene, Shape, Solid, World};

/// Side of the floor under a scene \[m\]; its middle is the world's origin. Source: ours, twice the longest place of the experiments.
const FLOOR_SIDE_M: f64 = 140.0;

/// A scene with the walls of `map` (world frame), or an open floor.
///
/// # Errors
/// When the map has no walls, or a number is outside its range.
pub fn scene_of_map(
    name: &str,
    map: Option<&OccupancyGrid>,
    start: Pose2,
    goal: Pose2,
) -> Result<Scene, AppError> {
    let mut solids = vec![floor()];
    if let Some(map) = map {
        let walls = raise_map(name, map, &RaisedMap::default());
        solids.extend(walls.map_err(|error| AppError::Input(error.to_string()))?);
    }
    Ok(Scene {
        name: name.to_owned(),
        world: World::new(solids, 1)?,
        lights: Lights::default(),
        people: Vec::new(),
        start,
        goal,
        station: None,
    })
}

/// The same map with another cell size, in the frame of `world_from_map`: a cell is occupied if the map is occupied at its middle or
/// halfway to a corner.
///
/// # Errors
/// When the resolution is outside its range.
pub fn map_from(
    world_from_map: Pose2,
    map: &OccupancyGrid,
    resolution: f64,
) -> Result<OccupancyGrid, Invalid> {
    let old = map.geometry();
    let (width, height) = (old.width as f64 * old.resolution, old.height as f64 * old.resolution);
    let corners = [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)];
    let corners = corners.map(|(x, y)| world_from_map.inverse().transform(old.origin + Vector2::new(x, y)));
    let bound = |pick: fn(&Vector2) -> f64, end: fn(f64, f64) -> f64| {
        corners.iter().map(pick).reduce(end).expect("invariant: four corners") / resolution
    };
    let low = [bound(|c| c.x, f64::min), bound(|c| c.y, f64::min)].map(f64::floor);
    let high = [bound(|c| c.x, f64::max), bound(|c| c.y, f64::max)].map(f64::ceil);
    let origin = Vector2::from(low) * resolution;
    let [cols, rows] = [0, 1].map(|i| (high[i] - low[i]) as usize);
    let mut grid = OccupancyGrid::filled(GridGeometry::new(resolution, origin, cols, rows)?, Cell::Unknown);
    let geometry = *grid.geometry();
    let around = [(0.0, 0.0), (1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    for k in 0..geometry.len() {
        let cell = geometry.cell(k);
        let at = |(x, y)| geometry.center(cell) + Vector2::new(x, y) * (0.25 * resolution);
        let mut values = around.map(|part| map.at(world_from_map.transform(at(part)))).into_iter();
        let middle = values.next().unwrap_or(Cell::Unknown);
        grid.set(cell, if values.any(|value| value == Cell::Occupied) { Cell::Occupied } else { middle });
    }
    Ok(grid)
}

/// A floor under the whole area of the maps.
fn floor() -> Solid {
    let size = Vector3::new(FLOOR_SIDE_M, FLOOR_SIDE_M, 0.1);
    let shape = Shape::Cuboid(Cuboid { center: Vector3::new(0.0, 0.0, -0.05), size, yaw: 0.0 });
    Solid { shape, finish: Finish::all(Paint::Flat { color: [150, 150, 150] }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_laid_anew_has_its_walls_where_they_are_seen_from_the_start() {
        let map =
            OccupancyGrid::from_ascii(0.05, &["#".repeat(40), ".".repeat(40), ".".repeat(40)].join("\n"));
        let (map, start) = (map.unwrap(), Pose2::new(1.0, 0.05, 0.3));
        let new = map_from(start, &map, 0.05).unwrap();
        let geometry = *new.geometry();
        for k in 0..geometry.len() {
            let (cell, at) = (new.cells()[k], start.transform(geometry.center(geometry.cell(k))));
            match cell {
                Cell::Occupied => assert!(at.y > 0.1 - 0.02, "{at}"),
                Cell::Free => assert!(at.y < 0.1 && at.y > 0.0),
                Cell::Unknown => assert!(map.at(at) == Cell::Unknown),
            }
        }
        let walls = new.cells().iter().filter(|cell| **cell == Cell::Occupied).count();
        assert!((40..=90).contains(&walls), "{walls}");
    }
}

//! The courses of the MRPB benchmark: start, goal, map and walking people, built as scenes.

use crate::csv_rows::rows;
use crate::data_sets::MRPB;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use trundle_app::AppError;
use trundle_core::{Cell, GridGeometry, Invalid, OccupancyGrid, Pose2, Vector2, Vector3};
use trundle_io::read_map;
use trundle_sim::import::{RaisedMap, raise_map};
use trundle_sim::{Cuboid, Finish, Lights, Paint, Person, Scene, Shape, Solid, World};

/// A start and a goal of the benchmark on one of its maps.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Course {
    /// The benchmark's name of the place.
    pub scenario: String,
    map: String,
    /// The benchmark's number of the pair.
    pub test: usize,
    /// Start pose, world frame (that of the map).
    pub start: Pose2,
    /// Goal pose, world frame.
    pub goal: Pose2,
    /// People on the course.
    pub people: Vec<Person>,
}

/// The benchmark's place without walls, whose map is only the frame of a picture.
const OPEN: &str = "empty_world";

/// All pairs of a folder; a pair with people also without them.
///
/// # Errors
/// When `start_goal.csv` or `actors.csv` is missing or a line is invalid.
pub fn read(folder: &Path) -> Result<Vec<Course>, AppError> {
    let mut courses = Vec::new();
    for row in rows(&folder.join("start_goal.csv"), 9, &MRPB)? {
        let pose = |at: usize| -> Result<Pose2, AppError> {
            Ok(Pose2::new(row.number(at)?, row.number(at + 1)?, row.number(at + 2)?))
        };
        let (scenario, map) = (row.text(0).to_owned(), row.text(1).to_owned());
        let (start, goal) = (pose(3)?, pose(6)?);
        let people = people(&folder.join("actors.csv"), &scenario)?;
        let course = Course { scenario, map, test: row.number(2)?, start, goal, people };
        if !course.people.is_empty() {
            courses.push(Course { people: Vec::new(), ..course.clone() });
        }
        courses.push(course);
    }
    Ok(courses)
}

impl Course {
    /// A course on the open floor, for tests.
    #[cfg(test)]
    pub fn between(scenario: &str, start: Pose2, goal: Pose2) -> Self {
        let (scenario, map) = (scenario.to_owned(), OPEN.to_owned());
        Self { scenario, map, test: 1, start, goal, people: Vec::new() }
    }

    /// Name with scenario, number, and presence of people.
    pub fn name(&self) -> String {
        let with = if self.people.is_empty() { "" } else { ", with people" };
        format!("{} {}{with}", self.scenario, self.test)
    }

    /// The benchmark's map in the frame of a robot at the start; `None` for the open floor.
    ///
    /// # Errors
    /// When the map cannot be read.
    pub fn known(&self, folder: &Path, resolution: f64) -> Result<Option<OccupancyGrid>, AppError> {
        if self.map == OPEN {
            return Ok(None);
        }
        Ok(Some(laid_anew(&read_map(&self.file(folder))?, self.start, resolution)?))
    }

    fn file(&self, folder: &Path) -> PathBuf {
        folder.join("maps").join(&self.map).join("map.yaml")
    }

    /// The simulated scene: the map's walls, or an open floor.
    ///
    /// # Errors
    /// When the map cannot be read, or a number is outside its range.
    pub fn scene(&self, folder: &Path) -> Result<Scene, AppError> {
        let mut solids = vec![floor()];
        if self.map != OPEN {
            let file = self.file(folder);
            let walls = raise_map(&file.display().to_string(), &read_map(&file)?, &RaisedMap::default());
            solids.extend(walls.map_err(|error| AppError::Input(error.to_string()))?);
        }
        Ok(Scene {
            name: self.scenario.clone(),
            world: World::new(solids, 1)?,
            lights: Lights::default(),
            people: self.people.clone(),
            start: self.start,
            goal: self.goal,
            station: None,
        })
    }
}

/// The same map with another cell size, in the frame of `world_from_map`: a cell is occupied if the map is occupied at its middle or
/// halfway to a corner.
fn laid_anew(map: &OccupancyGrid, world_from_map: Pose2, resolution: f64) -> Result<OccupancyGrid, Invalid> {
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
    let (center, size) = (Vector3::new(0.0, 0.0, -0.05), Vector3::new(40.0, 40.0, 0.1));
    let shape = Shape::Cuboid(Cuboid { center, size, yaw: 0.0 });
    Solid { shape, finish: Finish::all(Paint::Flat { color: [150, 150, 150] }) }
}

/// The people of a scenario. The benchmark gives each way-point a time. Here each person walks the same closed path at the mean speed of
/// its legs, with the mean duration of stops.
fn people(file: &Path, scenario: &str) -> Result<Vec<Person>, AppError> {
    let mut trajectories: Vec<(String, Vec<[f64; 3]>)> = Vec::new();
    for row in rows(file, 5, &MRPB)?.iter().filter(|row| row.text(0) == scenario) {
        let point = [row.number(2)?, row.number(3)?, row.number(4)?];
        match trajectories.last_mut().filter(|(name, _)| name == row.text(1)) {
            Some((_, trajectory)) => trajectory.push(point),
            None => trajectories.push((row.text(1).to_owned(), vec![point])),
        }
    }
    Ok(trajectories.iter().map(|(_, trajectory)| person(trajectory)).collect())
}

/// A person with its way-points (s, m, m).
fn person(trajectory: &[[f64; 3]]) -> Person {
    let (mut length, mut walking, mut standing, mut stops) = (0.0, 0.0, 0.0, 0_u32);
    let mut waypoints = vec![[trajectory[0][1], trajectory[0][2]]];
    for leg in trajectory.windows(2) {
        let (time, step) = (leg[1][0] - leg[0][0], (leg[1][1] - leg[0][1]).hypot(leg[1][2] - leg[0][2]));
        if step > 0.0 {
            (length, walking) = (length + step, walking + time);
            waypoints.push([leg[1][1], leg[1][2]]);
        } else {
            (standing, stops) = (standing + time, stops + 1);
        }
    }
    let around = waypoints.len() > 2 && waypoints.first() == waypoints.last();
    if around {
        waypoints.pop();
    }
    let (speed, pause) = ((length / walking).clamp(0.05, 3.0), standing / f64::from(stops.max(1)));
    Person { waypoints, speed, pause, around, ..Person::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_actor_becomes_a_person_who_walks_around() {
        let trajectory =
            [[0.0, 1.0, 5.0], [20.0, 1.0, 0.0], [25.0, 1.0, 0.0], [45.0, 1.0, 5.0], [50.0, 1.0, 5.0]];
        let person = person(&trajectory);
        assert_eq!(person.waypoints, [[1.0, 5.0], [1.0, 0.0]]);
        assert_eq!((person.speed, person.pause, person.around), (0.25, 5.0, true));
    }

    #[test]
    fn a_map_laid_anew_has_its_walls_where_they_are_seen_from_the_start() {
        let map =
            OccupancyGrid::from_ascii(0.05, &["#".repeat(40), ".".repeat(40), ".".repeat(40)].join("\n"));
        let (map, start) = (map.unwrap(), Pose2::new(1.0, 0.05, 0.3));
        let new = laid_anew(&map, start, 0.05).unwrap();
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

    #[test]
    fn a_pair_with_people_comes_twice() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        write(
            "start_goal.csv",
            "scenario,map,test,sx,sy,sa,gx,gy,ga\na,a,1,0,0,0,1,1,0\nb,b,2,0,0,0,1,1,1.57\n",
        );
        write("actors.csv", "scenario,actor,t,x,y,yaw\nb,one,0,3,0,0\nb,one,4,5,0,0\n");
        let names: Vec<String> = read(folder.path()).unwrap().iter().map(Course::name).collect();
        assert_eq!(names, ["a 1", "b 2", "b 2, with people"]);
    }
}

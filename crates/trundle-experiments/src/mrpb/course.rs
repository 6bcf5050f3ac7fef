//! The courses of the MRPB benchmark: start, goal, map and walking people, built as scenes.

use crate::csv_rows::rows;
use crate::data_sets::MRPB;
use crate::map_scene::{map_from, scene_of_map};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use trundle_app::AppError;
use trundle_core::{Hypotenuse, OccupancyGrid, Pose2};
use trundle_io::read_map;
use trundle_sim::{Person, Scene};

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
        Ok(Some(map_from(self.start, &read_map(&self.file(folder))?, resolution)?))
    }

    fn file(&self, folder: &Path) -> PathBuf {
        folder.join("maps").join(&self.map).join("map.yaml")
    }

    /// The simulated scene: the map's walls, or an open floor.
    ///
    /// # Errors
    /// When the map cannot be read, or a number is outside its range.
    pub fn scene(&self, folder: &Path) -> Result<Scene, AppError> {
        let map = (self.map != OPEN).then(|| read_map(&self.file(folder))).transpose()?;
        let mut scene = scene_of_map(&self.scenario, map.as_ref(), self.start, self.goal)?;
        scene.people = self.people.clone();
        Ok(scene)
    }
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
        let (time, step) = (leg[1][0] - leg[0][0], (leg[1][1] - leg[0][1]).hypotenuse(leg[1][2] - leg[0][2]));
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

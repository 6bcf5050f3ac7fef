//! Scene: a plain room without texture, whose scans look alike from several poses.

use super::Scene;
use super::builder::{Builder, Side, WALL_THICKNESS_M};
use crate::materials::{Finish, Paint};
use crate::people::Person;
use crate::world::{Lights, World};
use std::f64::consts::PI;
use trundle_core::{Invalid, Pose2};

/// Range of a side of the room, m. Source: ours.
const SIDE_RANGE_M: (f64, f64) = (3.0, 6.0);
/// Distance of the start, the goal and people from the walls, m. Source: ours.
const MARGIN_M: f64 = 0.7;
/// Side of the box in a room without symmetry, m. Source: ours.
const BOX_SIDE_M: f64 = 0.5;
/// Height of the box, m. Source: ours.
const BOX_HEIGHT_M: f64 = 0.8;
/// Range of walking speeds, m/s. Source: ours.
const SPEED_RANGE_M_S: (f64, f64) = (0.3, 1.2);
/// Range of the time that people stand at a way-point, s. Source: ours.
const PAUSE_RANGE_S: (f64, f64) = (0.0, 20.0);
/// Smallest distance of people's way-points from the robot's start, m. The smallest room has corners farther off. Source: ours.
const CLEAR_START_M: f64 = 0.9;
/// Number of way-points of a person. Source: ours.
const WAYPOINT_COUNT: usize = 3;

/// A room of 3 to 6 m with walls of one colour, and `people` who walk about.
///
/// With an even `seed` the room is an empty rectangle: it looks equal after half a turn, a square one after a quarter. With an odd seed a
/// box is in a corner. World frame: a corner at the origin.
///
/// # Errors
/// None for any seed; the result type is that of all scenes.
pub fn plain_room(seed: u64, people: usize) -> Result<Scene, Invalid> {
    let mut build = Builder::new(seed);
    let length = between(&mut build, SIDE_RANGE_M);
    let width = if seed.is_multiple_of(8) { length } else { between(&mut build, SIDE_RANGE_M) };
    shell(&mut build, length, width);
    if !seed.is_multiple_of(2) {
        let middle = MARGIN_M / 2.0;
        let finish = Finish::all(Paint::Flat { color: [150, 150, 150] });
        let size = [BOX_SIDE_M, BOX_SIDE_M, BOX_HEIGHT_M];
        build.block(Pose2::new(middle, middle, 0.0), (0.0, 0.0), 0.0, size, finish);
    }
    let room = (length, width);
    let (start, goal) = (place(&mut build, room), place(&mut build, room));
    let people = (0..people).map(|_| walker(&mut build, room, start)).collect();
    Ok(Scene {
        name: format!("plain room {seed}"),
        world: World::new(build.solids, seed)?,
        lights: Lights::default(),
        people,
        start,
        goal,
        station: None,
    })
}

/// A pose inside the room.
fn place(build: &mut Builder, (length, width): (f64, f64)) -> Pose2 {
    let x = between(build, (MARGIN_M, length - MARGIN_M));
    let y = between(build, (MARGIN_M, width - MARGIN_M));
    Pose2::new(x, y, between(build, (-PI, PI)))
}

/// A person whose way-points keep off the robot's start.
fn walker(build: &mut Builder, room: (f64, f64), start: Pose2) -> Person {
    let places = std::iter::repeat_with(|| place(build, room));
    let free = places.filter(|at| at.distance(&start) > CLEAR_START_M).take(WAYPOINT_COUNT);
    let waypoints = free.map(|at| [at.x, at.y]).collect();
    let (speed, pause) = (between(build, SPEED_RANGE_M_S), between(build, PAUSE_RANGE_S));
    Person { waypoints, speed, pause, around: true, ..Person::default() }
}

fn between(build: &mut Builder, (low, high): (f64, f64)) -> f64 {
    let half = (high - low) / 2.0;
    low + half + build.jitter(half)
}

/// Floor, ceiling and walls of one colour each.
fn shell(build: &mut Builder, length: f64, width: f64) {
    let grey = |level: u8| Paint::Flat { color: [level; 3] };
    let (low, x, y) = (-WALL_THICKNESS_M, length + WALL_THICKNESS_M, width + WALL_THICKNESS_M);
    build.floor_and_ceiling([low, low, x, y], grey(120));
    let wall = grey(190);
    build.wall([low, low, 0.0, y], &[(Side::East, wall)]);
    build.wall([length, low, x, y], &[(Side::West, wall)]);
    build.wall([0.0, low, length, 0.0], &[(Side::North, wall)]);
    build.wall([0.0, width, length, y], &[(Side::South, wall)]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_seed_gives_a_room_with_start_goal_and_people_inside() {
        for seed in 0..40 {
            let scene = plain_room(seed, 3).unwrap();
            assert_eq!(scene.people.len(), 3);
            let people = scene.people.iter().flat_map(|person| person.waypoints.clone());
            let points = people.chain([[scene.start.x, scene.start.y], [scene.goal.x, scene.goal.y]]);
            points.for_each(|[x, y]| {
                let inside = MARGIN_M..=SIDE_RANGE_M.1 - MARGIN_M;
                assert!(inside.contains(&x) && inside.contains(&y), "seed {seed}: ({x}, {y})");
            });
            assert!(scene.start.theta.abs() <= PI);
        }
    }

    #[test]
    fn people_do_not_change_the_room() {
        let (alone, crowded) = (plain_room(4, 0).unwrap(), plain_room(4, 3).unwrap());
        assert_eq!((alone.start, alone.goal), (crowded.start, crowded.goal));
    }
}

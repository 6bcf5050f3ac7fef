//! Scene: two furnished rooms with a door.

use super::Scene;
use super::builder::{Builder, ROOM_HEIGHT, Side, UNSEEN, WALL_THICKNESS_M};
use crate::materials::{Finish, Paint};
use crate::world::{Lights, World};
use std::f64::consts::{FRAC_PI_2, PI};
use trundle_core::{Invalid, Pose2};

/// Inner size of both rooms together, m. Source: ours.
const ROOM_LENGTH_M: f64 = 8.0;
const ROOM_WIDTH_M: f64 = 6.0;

/// West face of the wall between the rooms, m. Source: ours.
const PARTITION_X_M: f64 = 4.35;

/// The door: clear width and height, m. Source: ours.
const DOOR_WIDTH: f64 = 1.0;
const DOOR_HEIGHT: f64 = 2.02;

/// Height of low tables: too low for the robot (0.6 m) to pass under; a flat laser near the floor hits only their legs. Source: ours.
const LOW_TABLE: f64 = 0.45;

/// High tables: the robot passes under. Source: ours.
const HIGH_TABLE: f64 = 0.72;

/// Two furnished rooms, 8 x 6 m together, and a door between them (world frame: x 0 to 8, y 0 to 6).
///
/// The robot starts in the west room; its goal is in the east room, 6 m away, behind the wall. The path leads around a low table (0.45 m),
/// through a door 1.0 m wide with an open leaf, and around a second low table. `seed` varies the textures, the door's position by 0.12 m,
/// and the furniture by some centimetres and degrees; the path is at least 0.8 m wide.
///
/// # Errors
/// None for any seed; the result type is that of all scenes.
pub fn demo_room(seed: u64) -> Result<Scene, Invalid> {
    let mut build = Builder::new(seed);
    let door = 3.9 + build.jitter(0.12);
    shell(&mut build);
    partition(&mut build, door);
    west_room(&mut build);
    east_room(&mut build);
    Ok(Scene {
        name: "demo".into(),
        world: World::new(build.solids, seed)?,
        lights: Lights::default(),
        people: Vec::new(),
        start: Pose2::new(0.9, 1.1, 0.35),
        goal: Pose2::new(6.9, 1.5, -FRAC_PI_2),
        station: None,
    })
}

fn shell(build: &mut Builder) {
    let middle = PARTITION_X_M + WALL_THICKNESS_M / 2.0;
    let wood = Paint::Boards { color: build.choose(&[[178, 134, 88], [150, 104, 66], [196, 160, 112]]) };
    let stone = Paint::Tiles { color: build.choose(&[[188, 180, 166], [164, 176, 178], [190, 166, 144]]) };
    build.floor_and_ceiling(
        [-WALL_THICKNESS_M, -WALL_THICKNESS_M, middle, ROOM_WIDTH_M + WALL_THICKNESS_M],
        wood,
    );
    build.floor_and_ceiling(
        [middle, -WALL_THICKNESS_M, ROOM_LENGTH_M + WALL_THICKNESS_M, ROOM_WIDTH_M + WALL_THICKNESS_M],
        stone,
    );
    let cool = Paint::Plaster { color: build.choose(&[[168, 184, 190], [180, 186, 170]]), prints: 0.75 };
    let warm = Paint::Plaster { color: build.choose(&[[204, 186, 160], [198, 176, 172]]), prints: 0.75 };
    let paper =
        Paint::Wallpaper { color: build.choose(&[[176, 190, 164], [196, 180, 150], [170, 172, 192]]) };
    build.wall(
        [-WALL_THICKNESS_M, -WALL_THICKNESS_M, 0.0, ROOM_WIDTH_M + WALL_THICKNESS_M],
        &[(Side::East, Paint::Bricks)],
    );
    build.wall(
        [ROOM_LENGTH_M, -WALL_THICKNESS_M, ROOM_LENGTH_M + WALL_THICKNESS_M, ROOM_WIDTH_M + WALL_THICKNESS_M],
        &[(Side::West, paper)],
    );
    build.wall([0.0, -WALL_THICKNESS_M, middle, 0.0], &[(Side::North, paper)]);
    build.wall([middle, -WALL_THICKNESS_M, ROOM_LENGTH_M, 0.0], &[(Side::North, warm)]);
    build.wall([0.0, ROOM_WIDTH_M, middle, ROOM_WIDTH_M + WALL_THICKNESS_M], &[(Side::South, cool)]);
    build.wall(
        [middle, ROOM_WIDTH_M, ROOM_LENGTH_M, ROOM_WIDTH_M + WALL_THICKNESS_M],
        &[(Side::South, Paint::Bricks)],
    );
}

/// The wall between the rooms with its door centred at `door` (y, m), the leaf open into the east room.
fn partition(build: &mut Builder, door: f64) {
    let (x0, x1) = (PARTITION_X_M, PARTITION_X_M + WALL_THICKNESS_M);
    let (south, north) = (door - DOOR_WIDTH / 2.0, door + DOOR_WIDTH / 2.0);
    let frame = Paint::Veneer { color: [214, 208, 196] };
    let west = Paint::Plaster { color: [206, 190, 150], prints: 0.8 };
    let east = Paint::Plaster { color: [160, 178, 186], prints: 0.8 };
    let sides = [(Side::West, west), (Side::East, east), (Side::South, frame), (Side::North, frame)];
    build.wall([x0, 0.0, x1, south], &sides);
    build.wall([x0, north, x1, ROOM_WIDTH_M], &sides);
    let lintel = [(Side::West, west), (Side::East, east), (Side::Bottom, frame)];
    build.slab([x0, south, DOOR_HEIGHT], [x1, north, ROOM_HEIGHT], &lintel);
    let hinge = Pose2::new(x1 + 0.01, north + 0.03, 0.2 + build.jitter(0.1));
    let mut leaf = Finish::all(Paint::Plaster { color: [196, 150, 104], prints: 0.7 });
    leaf.faces[Side::Top as usize] = UNSEEN;
    leaf.faces[Side::Bottom as usize] = UNSEEN;
    build.block(hinge, (DOOR_WIDTH / 2.0, 0.0), 0.005, [DOOR_WIDTH - 0.02, 0.04, DOOR_HEIGHT - 0.02], leaf);
}

fn west_room(build: &mut Builder) {
    let along = build.jitter(0.12);
    build.bookcase(Pose2::new(1.5 + along, ROOM_WIDTH_M - 0.17, 0.0), [1.8, 0.32, 1.9]);
    let along = build.jitter(0.1);
    build.sofa(Pose2::new(0.45, 3.7 + along, 0.0), [0.85, 1.7, 0.82]);
    let place = build.jittered(Pose2::new(2.3, 2.75, 0.0), 0.05, 0.08);
    build.table(place, [1.0, 0.6, LOW_TABLE]);
    let place = build.jittered(Pose2::new(3.2, 5.3, 0.0), 0.05, 0.06);
    build.table(place, [1.1, 0.7, HIGH_TABLE]);
    let place = build.jittered(Pose2::new(2.2, 4.75, 0.0), 0.06, 0.0);
    build.stool(place);
    let place = build.jittered(Pose2::new(3.8, 0.45, 0.1), 0.05, 0.1);
    build.cartons(place, [0.55, 0.45, 0.5]);
    let place = build.jittered(Pose2::new(2.6, 0.4, -0.1), 0.05, 0.1);
    build.carton(place, [0.45, 0.35, 0.38]);
    let along = build.jitter(0.08);
    build.bin(Pose2::new(PARTITION_X_M - 0.2, 2.5 + along, 0.0));
}

fn east_room(build: &mut Builder) {
    let place = build.jittered(Pose2::new(5.85, 2.6, 0.3), 0.05, 0.08);
    build.table(place, [0.8, 0.6, LOW_TABLE]);
    let along = build.jitter(0.1);
    build.table(Pose2::new(ROOM_LENGTH_M - 0.37, 4.2 + along, 0.0), [0.7, 1.4, HIGH_TABLE]);
    let along = build.jitter(0.1);
    build.bookcase(Pose2::new(6.3 + along, 0.17, PI), [1.5, 0.32, 1.8]);
    build.cabinet(Pose2::new(PARTITION_X_M + WALL_THICKNESS_M + 0.24, 0.8, 0.0), [0.46, 0.9, 1.15]);
    let along = build.jitter(0.1);
    build.sofa(Pose2::new(6.4 + along, ROOM_WIDTH_M - 0.43, -FRAC_PI_2), [0.8, 1.5, 0.82]);
    let place = build.jittered(Pose2::new(7.6, 0.42, 0.2), 0.05, 0.1);
    build.cartons(place, [0.5, 0.42, 0.45]);
    let place = build.jittered(Pose2::new(4.95, 5.55, -0.1), 0.05, 0.1);
    build.cartons(place, [0.6, 0.5, 0.55]);
    let place = build.jittered(Pose2::new(7.6, 5.55, 0.0), 0.05, 0.0);
    build.plant(place);
    let place = build.jittered(Pose2::new(7.65, 2.3, 0.0), 0.04, 0.0);
    build.bin(place);
}

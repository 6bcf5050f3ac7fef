//! The ring corridor of the office scene.

use super::super::builder::{Builder, ROOM_HEIGHT, Side, UNSEEN};
use super::super::partition::{Along, Partition};
use super::layout::{CORE, DOOR_CENTRE_X_M, HALF_WALL, NORTH_ROOMS_Y_M, ROOM_SIZE_M};
use crate::materials::Paint;
use std::f64::consts::{FRAC_PI_2, PI};
use trundle_core::Pose2;

/// East side of the building, m. Source: ours, three rooms in a row.
const EAST_SIDE_X_M: f64 = 3.0 * ROOM_SIZE_M[0];

/// South side of the corridor, m.
const CORRIDOR_SOUTH_Y_M: f64 = ROOM_SIZE_M[1];

const JAMB: Paint = Paint::Plain { color: [206, 204, 198] };

/// The ring corridor: floor, ceiling, walls with the rooms' doors, the core, and the furnishings.
pub(super) fn place(build: &mut Builder) {
    let wall = Paint::Plain { color: build.choose(&[[208, 204, 194], [200, 206, 206], [206, 198, 188]]) };
    shell(build, wall);
    core(build, wall);
    let wood = build.choose(&[[150, 112, 74], [120, 92, 70], [168, 136, 98]]);
    closed_doors(build, wood);
    prints(build);
    signs(build);
    furniture(build);
}

fn shell(build: &mut Builder, wall: Paint) {
    let carpet = Paint::Carpet { color: build.choose(&[[104, 110, 122], [112, 118, 104], [122, 108, 100]]) };
    let ([x0, y0], [x1, y1]) = (CORE[0], CORE[1]);
    for rectangle in [
        [0.0, CORRIDOR_SOUTH_Y_M, EAST_SIDE_X_M, y0],
        [0.0, y1, EAST_SIDE_X_M, NORTH_ROOMS_Y_M],
        [0.0, y0, x0, y1],
        [x1, y0, EAST_SIDE_X_M, y1],
    ] {
        build.floor_and_ceiling(rectangle, carpet);
    }
    let doors = [DOOR_CENTRE_X_M, ROOM_SIZE_M[0] + DOOR_CENTRE_X_M, 2.0 * ROOM_SIZE_M[0] + DOOR_CENTRE_X_M];
    let along_x =
        |faces, paints| Partition { along: Along::X, span: [0.0, EAST_SIDE_X_M], faces, paints, jamb: JAMB };
    build.partition(&along_x([CORRIDOR_SOUTH_Y_M, CORRIDOR_SOUTH_Y_M + HALF_WALL], [UNSEEN, wall]), &doors);
    build.partition(&along_x([NORTH_ROOMS_Y_M - HALF_WALL, NORTH_ROOMS_Y_M], [wall, UNSEEN]), &doors);
    build.wall([-HALF_WALL, CORRIDOR_SOUTH_Y_M, HALF_WALL, NORTH_ROOMS_Y_M], &[(Side::East, wall)]);
    build.wall(
        [EAST_SIDE_X_M - HALF_WALL, CORRIDOR_SOUTH_Y_M, EAST_SIDE_X_M + HALF_WALL, NORTH_ROOMS_Y_M],
        &[(Side::West, wall)],
    );
}

fn core(build: &mut Builder, wall: Paint) {
    let [[x0, y0], [x1, y1]] = CORE;
    let seen = [Side::East, Side::West, Side::North, Side::South].map(|side| (side, wall));
    build.slab([x0, y0, 0.0], [x1, y1, ROOM_HEIGHT], &seen);
}

/// Doors of shafts and closets in the core, all alike.
fn closed_doors(build: &mut Builder, wood: [u8; 3]) {
    let [[x0, y0], [x1, y1]] = CORE;
    let middle = (y0 + y1) / 2.0;
    let south = [3.25, 7.5, 11.75].map(|x| Pose2::new(x, y0, -FRAC_PI_2));
    let north = [3.25, 7.5, 11.75].map(|x| Pose2::new(x, y1, FRAC_PI_2));
    let ends = [Pose2::new(x0, middle, PI), Pose2::new(x1, middle, 0.0)];
    for place in south.into_iter().chain(north).chain(ends) {
        build.alike(7, |build| build.closed_door(place, wood));
    }
}

/// Posters and notice boards between the doors, on most of their places.
fn prints(build: &mut Builder) {
    let [[x0, y0], [x1, y1]] = CORE;
    let on_core = [2.2, 5.4, 9.6, 12.8];
    let south_core = on_core.map(|x| Pose2::new(x, y0, -FRAC_PI_2));
    let north_core = on_core.map(|x| Pose2::new(x, y1, FRAC_PI_2));
    let south = [1.4, 6.2, 11.3].map(|x| Pose2::new(x, CORRIDOR_SOUTH_Y_M + HALF_WALL, FRAC_PI_2));
    let north = [1.6, 6.4, 11.1].map(|x| Pose2::new(x, NORTH_ROOMS_Y_M - HALF_WALL, -FRAC_PI_2));
    let west = [6.6, 8.6, 11.4].map(|y| Pose2::new(HALF_WALL, y, 0.0));
    let east = [6.4, 9.6, 11.8].map(|y| Pose2::new(EAST_SIDE_X_M - HALF_WALL, y, PI));
    let ends = [7.2, 10.9].into_iter().flat_map(|y| [Pose2::new(x0, y, PI), Pose2::new(x1, y, 0.0)]);
    let sides = south.into_iter().chain(north).chain(west).chain(east).chain(ends);
    for place in south_core.into_iter().chain(north_core).chain(sides) {
        let place = build.jittered(place, 0.0, 0.0);
        if build.happens(0.8) {
            let size = (0.75 + build.jitter(0.25), 0.75 + build.jitter(0.25));
            let middle = 1.45 + build.jitter(0.15);
            build.board(place, middle, size, Paint::Print);
        }
    }
}

/// Signs with the room numbers next to the doors.
fn signs(build: &mut Builder) {
    for k in 0..3 {
        let x = ROOM_SIZE_M[0] * f64::from(k) + DOOR_CENTRE_X_M - 0.75;
        for place in [
            Pose2::new(x, CORRIDOR_SOUTH_Y_M + HALF_WALL, FRAC_PI_2),
            Pose2::new(x, NORTH_ROOMS_Y_M - HALF_WALL, -FRAC_PI_2),
        ] {
            build.board(place, 1.55, (0.26, 0.16), Paint::Sign { color: [44, 74, 110] });
        }
    }
}

fn furniture(build: &mut Builder) {
    let inset = HALF_WALL + 0.3;
    build.plant(Pose2::new(inset, CORRIDOR_SOUTH_Y_M + inset, 0.0));
    build.plant(Pose2::new(EAST_SIDE_X_M - inset, NORTH_ROOMS_Y_M - inset, 0.0));
    let along = build.jitter(0.3);
    build.extinguisher(Pose2::new(CORE[0][0] - 0.12, 7.9 + along, 0.0));
    build.extinguisher(Pose2::new(CORE[1][0] + 0.12, 10.2 + along, 0.0));
    build.bin(Pose2::new(10.6 + along, CORE[0][1] - 0.17, 0.0));
    let bench = build.jitter(0.4);
    build.cabinet(Pose2::new(HALF_WALL + 0.2, 9.9 + bench, 0.0), [0.38, 1.3, 0.45]);
    build.cabinet(Pose2::new(EAST_SIDE_X_M - HALF_WALL - 0.2, 7.9 + bench, 0.0), [0.38, 1.0, 1.05]);
    build.carton(Pose2::new(5.2 - bench, CORE[1][1] + 0.25, 0.1), [0.5, 0.36, 0.4]);
}

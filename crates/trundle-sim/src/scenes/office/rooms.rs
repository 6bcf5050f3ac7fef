//! The office's rooms, each placed by its south-west corner.

use super::super::builder::{Builder, Side, UNSEEN};
use super::super::partition::{Along, DOOR_WIDTH, Partition};
use super::layout::{DOOR_CENTRE_X_M, HALF_WALL, ROOM_SIZE_M};
use crate::materials::{Finish, Paint};
use std::f64::consts::{FRAC_PI_2, PI};
use trundle_core::Pose2;

/// The long wall of a room that contains the door.
#[derive(Clone, Copy, PartialEq, Eq)]
enum DoorIn {
    South,
    North,
}

/// An office for two: desks at the west wall, door in the north.
pub(super) fn office(build: &mut Builder, corner: Pose2) {
    let carpet = Paint::Carpet { color: build.choose(&[[96, 104, 118], [118, 106, 92]]) };
    shell(build, corner, DoorIn::North, carpet, [214, 208, 194]);
    let at = |x, y, heading| corner * Pose2::new(x, y, heading);
    for y in [1.1, 3.1] {
        build.desk(at(0.45, y, 0.0), (0.7, 1.5));
        let chair = build.jittered(at(1.2, y, PI), 0.06, 0.4);
        build.chair(chair, [0.46, 0.46, 0.92]);
    }
    build.bookcase(at(2.75, 0.24, PI), [1.5, 0.32, 1.9]);
    build.cabinet(at(4.68, 1.6, 0.0), [0.46, 0.9, 1.15]);
    build.plant(at(4.55, 0.45, 0.0));
    build.bin(at(0.3, 2.1, 0.0));
    build.window(at(1.1, HALF_WALL, FRAC_PI_2), (1.3, 1.15));
    build.board(at(1.6, ROOM_SIZE_M[1] - HALF_WALL, -FRAC_PI_2), 1.5, (1.4, 0.95), Paint::Print);
    build.board(at(ROOM_SIZE_M[0] - HALF_WALL, 2.75, PI), 1.5, (0.6, 0.85), Paint::Print);
}

/// A meeting room: a table with six chairs, door in the south.
pub(super) fn meeting(build: &mut Builder, corner: Pose2) {
    let carpet = Paint::Carpet { color: build.choose(&[[86, 100, 92], [104, 92, 108]]) };
    shell(build, corner, DoorIn::South, carpet, [204, 210, 208]);
    let at = |x, y, heading| corner * Pose2::new(x, y, heading);
    build.table(at(2.1, 2.6, 0.0), [2.2, 0.95, 0.74]);
    for (nth, x) in [1.35, 2.1, 2.85].into_iter().enumerate() {
        let tucked = 0.05 * nth as f64;
        let south = build.jittered(at(x, 1.95 - tucked, FRAC_PI_2), 0.04, 0.2);
        build.chair(south, [0.46, 0.46, 0.92]);
        let north = build.jittered(at(x, 3.3 + tucked, -FRAC_PI_2), 0.04, 0.2);
        build.chair(north, [0.46, 0.46, 0.92]);
    }
    build.cabinet(at(4.68, 3.4, 0.0), [0.46, 1.4, 0.8]);
    build.plant(at(0.4, 0.4, 0.0));
    build.window(at(2.4, ROOM_SIZE_M[1] - HALF_WALL, -FRAC_PI_2), (2.2, 1.15));
    build.board(at(HALF_WALL, 2.6, 0.0), 1.4, (1.8, 1.1), Paint::Print);
    build.board(at(1.5, HALF_WALL, FRAC_PI_2), 1.5, (0.9, 0.65), Paint::Print);
}

/// A pantry: a kitchen counter, a fridge, a vending machine, a table; door in the north.
pub(super) fn pantry(build: &mut Builder, corner: Pose2) {
    shell(build, corner, DoorIn::North, Paint::Tiles { color: [186, 182, 172] }, [216, 206, 180]);
    let at = |x, y, heading| corner * Pose2::new(x, y, heading);
    let color = build.choose(&[[176, 60, 52], [70, 110, 120], [206, 196, 170]]);
    build.counter(at(1.35, 0.38, FRAC_PI_2), [0.6, 2.4, 0.92], color);
    let mut upper = Finish::all(Paint::Plain { color });
    upper.faces[Side::East as usize] = Paint::Fronts { color };
    build.block(at(1.35, 0.24, FRAC_PI_2), (0.0, 0.0), 1.45, [0.35, 2.4, 0.6], upper);
    build.fridge(at(2.95, 0.39, FRAC_PI_2));
    let mut machine = Finish::all(Paint::Metal { color: [60, 70, 90] });
    machine.faces[Side::East as usize] = Paint::Print;
    build.block(at(4.52, 1.6, PI), (0.0, 0.0), 0.0, [0.8, 0.9, 1.83], machine);
    build.table(at(1.5, 2.75, 0.0), [1.0, 1.0, 0.74]);
    for (dx, dy, heading) in [(0.75, 0.0, PI), (-0.75, 0.0, 0.0), (0.0, 0.75, -FRAC_PI_2)] {
        let chair = build.jittered(at(1.5 + dx, 2.75 + dy, heading), 0.05, 0.3);
        build.chair(chair, [0.44, 0.44, 0.88]);
    }
    build.bin(at(3.5, 0.3, 0.0));
    build.board(at(HALF_WALL, 2.6, 0.0), 1.5, (1.0, 0.7), Paint::Print);
}

/// A store: shelves, cartons, a pallet, drums; door in the south.
pub(super) fn store(build: &mut Builder, corner: Pose2) {
    shell(build, corner, DoorIn::South, Paint::Concrete { color: [150, 148, 142] }, [188, 188, 184]);
    let at = |x, y, heading| corner * Pose2::new(x, y, heading);
    for y in [1.3, 3.3] {
        build.bookcase(at(0.29, y, FRAC_PI_2), [1.8, 0.4, 2.0]);
    }
    let pallet = build.jittered(at(2.3, 3.75, 0.0), 0.06, 0.1);
    build.loaded_pallet(pallet, [1.2, 0.8, 1.15]);
    for (x, y) in [(4.45, 3.9), (4.5, 3.2), (3.75, 4.0)] {
        build.drum(at(x, y, 0.0), 0.0);
    }
    for (x, y) in [(1.7, 0.45), (2.4, 0.5)] {
        let place = build.jittered(at(x, y, 0.0), 0.05, 0.3);
        build.cartons(place, [0.55, 0.45, 0.45]);
    }
    build.board(
        at(ROOM_SIZE_M[0] - HALF_WALL, 2.4, PI),
        1.6,
        (0.5, 0.35),
        Paint::Sign { color: [168, 120, 20] },
    );
}

fn shell(build: &mut Builder, corner: Pose2, door_in: DoorIn, floor: Paint, color: [u8; 3]) {
    let (x0, y0) = (corner.x, corner.y);
    let (x1, y1) = (x0 + ROOM_SIZE_M[0], y0 + ROOM_SIZE_M[1]);
    build.floor_and_ceiling([x0, y0, x1, y1], floor);
    let wall = Paint::Plaster { color, prints: 0.12 };
    build.wall([x0, y0, x0 + HALF_WALL, y1], &[(Side::East, wall)]);
    build.wall([x1 - HALF_WALL, y0, x1, y1], &[(Side::West, wall)]);
    let south = long_wall(corner, [y0, y0 + HALF_WALL], [UNSEEN, wall]);
    let north = long_wall(corner, [y1 - HALF_WALL, y1], [wall, UNSEEN]);
    let door = [x0 + DOOR_CENTRE_X_M];
    let (with_door, without, direction) = match door_in {
        DoorIn::South => (south, north, 1.0),
        DoorIn::North => (north, south, -1.0),
    };
    build.partition(&with_door, &door);
    build.partition(&without, &[]);
    let inner = if door_in == DoorIn::South { y0 + HALF_WALL } else { y1 - HALF_WALL };
    let hinge = Pose2::new(
        x0 + DOOR_CENTRE_X_M + DOOR_WIDTH / 2.0 + 0.03125,
        inner + direction * 0.03125,
        direction * FRAC_PI_2,
    );
    build.door_leaf(hinge, [158, 120, 80]);
}

fn long_wall(corner: Pose2, faces: [f64; 2], paints: [Paint; 2]) -> Partition {
    let span = [corner.x + HALF_WALL, corner.x + ROOM_SIZE_M[0] - HALF_WALL];
    let jamb = Paint::Plain { color: [206, 204, 198] };
    Partition { along: Along::X, span, faces, paints, jamb }
}

//! Scene: a furnished flat of six rooms.

use super::Scene;
use super::builder::{Builder, Side, WALL_THICKNESS_M};
use super::partition::{Along, DOOR_WIDTH, Partition};
use crate::materials::Paint;
use crate::world::{Lights, World};
use std::f64::consts::{FRAC_PI_2, PI};
use trundle_core::{Invalid, Pose2};

/// Inner size of the flat, m. Source: ours.
const FLAT_SIZE_M: [f64; 2] = [10.0, 8.0];

/// South and north face of the hall, m. Source: ours.
const HALL_FACES_Y_M: [f64; 2] = [3.7, 4.9];

/// West face of the wall between hall and living room, m. Source: ours.
const LIVING_ROOM_WALL_X_M: f64 = 5.5;

/// West face of the wall between bath and study, m. Source: ours.
const BATH_WALL_X_M: f64 = 2.6;

/// Appearance of rooms.
struct HouseMaterials {
    bedroom: Paint,
    bath: Paint,
    study: Paint,
    hall: Paint,
    living: Paint,
    kitchen: Paint,
}

/// A furnished flat of six rooms, 10 x 8 m (world frame: x 0 to 10, y 0 to 8).
///
/// West: a hall 1.2 m wide between the bedroom (south) and bath and study (north). East: the living room, and through it
/// the kitchen. Doors are 1.0 m wide. The robot starts in the hall; its goal is in the kitchen. `seed` varies textures and
/// colours, and furniture by some centimetres and degrees; every room can be reached on paths 0.8 m wide.
///
/// # Errors
/// None for any seed; the result type is that of all scenes.
pub fn house(seed: u64) -> Result<Scene, Invalid> {
    let mut build = Builder::new(seed);
    let materials = materials(&mut build);
    floors(&mut build);
    outer_walls(&mut build, &materials);
    inner_walls(&mut build, &materials);
    bedroom(&mut build);
    bath(&mut build);
    study(&mut build);
    hall(&mut build);
    living(&mut build);
    kitchen(&mut build);
    Ok(Scene {
        name: "house".into(),
        world: World::new(build.solids, seed)?,
        lights: Lights::default(),
        people: Vec::new(),
        start: Pose2::new(0.7, 4.4, 0.0),
        goal: Pose2::new(7.4, 6.4, FRAC_PI_2),
        station: None,
    })
}

fn materials(build: &mut Builder) -> HouseMaterials {
    let plaster = |color, prints| Paint::Plaster { color, prints };
    HouseMaterials {
        bedroom: Paint::Wallpaper {
            color: build.choose(&[[186, 192, 204], [204, 190, 190], [190, 200, 184]]),
        },
        bath: Paint::Tiles { color: build.choose(&[[200, 214, 216], [214, 208, 196]]) },
        study: plaster(build.choose(&[[206, 196, 168], [190, 200, 196]]), 0.4),
        hall: plaster(build.choose(&[[214, 204, 188], [204, 206, 198]]), 0.3),
        living: plaster(build.choose(&[[216, 202, 172], [198, 206, 200], [206, 190, 176]]), 0.35),
        kitchen: plaster(build.choose(&[[222, 214, 182], [204, 212, 206]]), 0.2),
    }
}

fn floors(build: &mut Builder) {
    let wood = Paint::Boards { color: build.choose(&[[178, 134, 88], [150, 104, 66], [196, 160, 112]]) };
    let tiles = |color| Paint::Tiles { color };
    let ([x1, y1], half) = (FLAT_SIZE_M, WALL_THICKNESS_M / 2.0);
    let (north, middle) = (HALL_FACES_Y_M[1] + half, LIVING_ROOM_WALL_X_M + half);
    build.floor_and_ceiling([-WALL_THICKNESS_M, -WALL_THICKNESS_M, middle, north], wood);
    build.floor_and_ceiling(
        [-WALL_THICKNESS_M, north, BATH_WALL_X_M + half, y1 + WALL_THICKNESS_M],
        tiles([184, 190, 190]),
    );
    build.floor_and_ceiling([BATH_WALL_X_M + half, north, middle, y1 + WALL_THICKNESS_M], wood);
    build.floor_and_ceiling([middle, -WALL_THICKNESS_M, x1 + WALL_THICKNESS_M, north], wood);
    build.floor_and_ceiling(
        [middle, north, x1 + WALL_THICKNESS_M, y1 + WALL_THICKNESS_M],
        tiles([192, 178, 160]),
    );
}

/// The outer walls, room by room.
fn outer_walls(build: &mut Builder, materials: &HouseMaterials) {
    let ([x1, y1], half) = (FLAT_SIZE_M, WALL_THICKNESS_M / 2.0);
    let (south, north) = (HALL_FACES_Y_M[0] - half, HALL_FACES_Y_M[1] + half);
    build.wall([-WALL_THICKNESS_M, -WALL_THICKNESS_M, 0.0, south], &[(Side::East, materials.bedroom)]);
    build.wall([-WALL_THICKNESS_M, south, 0.0, north], &[(Side::East, materials.hall)]);
    build.wall([-WALL_THICKNESS_M, north, 0.0, y1 + WALL_THICKNESS_M], &[(Side::East, materials.bath)]);
    build.wall(
        [0.0, -WALL_THICKNESS_M, LIVING_ROOM_WALL_X_M + half, 0.0],
        &[(Side::North, materials.bedroom)],
    );
    build.wall([LIVING_ROOM_WALL_X_M + half, -WALL_THICKNESS_M, x1, 0.0], &[(Side::North, materials.living)]);
    build.wall([x1, -WALL_THICKNESS_M, x1 + WALL_THICKNESS_M, north], &[(Side::West, Paint::Bricks)]);
    build.wall([x1, north, x1 + WALL_THICKNESS_M, y1 + WALL_THICKNESS_M], &[(Side::West, materials.kitchen)]);
    build.wall([0.0, y1, BATH_WALL_X_M + half, y1 + WALL_THICKNESS_M], &[(Side::South, materials.bath)]);
    build.wall(
        [BATH_WALL_X_M + half, y1, LIVING_ROOM_WALL_X_M + half, y1 + WALL_THICKNESS_M],
        &[(Side::South, materials.study)],
    );
    build.wall(
        [LIVING_ROOM_WALL_X_M + half, y1, x1, y1 + WALL_THICKNESS_M],
        &[(Side::South, materials.kitchen)],
    );
}

/// The inner walls with their doors, and the doors' leaves.
fn inner_walls(build: &mut Builder, materials: &HouseMaterials) {
    let jamb = Paint::Plain { color: [224, 220, 210] };
    let wall = |along, span, low: f64, paints| Partition {
        along,
        span,
        faces: [low, low + WALL_THICKNESS_M],
        paints,
        jamb,
    };
    let (south, north) = (HALL_FACES_Y_M[0] - WALL_THICKNESS_M, HALL_FACES_Y_M[1]);
    build.partition(
        &wall(Along::X, [0.0, LIVING_ROOM_WALL_X_M], south, [materials.bedroom, materials.hall]),
        &[4.4],
    );
    build.partition(&wall(Along::X, [0.0, BATH_WALL_X_M], north, [materials.hall, materials.bath]), &[1.3]);
    build.partition(
        &wall(Along::X, [BATH_WALL_X_M, LIVING_ROOM_WALL_X_M], north, [materials.hall, materials.study]),
        &[4.3],
    );
    build.partition(
        &wall(
            Along::X,
            [LIVING_ROOM_WALL_X_M + WALL_THICKNESS_M, FLAT_SIZE_M[0]],
            north,
            [materials.living, materials.kitchen],
        ),
        &[7.4],
    );
    build.partition(
        &wall(
            Along::Y,
            [north + WALL_THICKNESS_M, FLAT_SIZE_M[1]],
            BATH_WALL_X_M,
            [materials.bath, materials.study],
        ),
        &[],
    );
    build.partition(
        &wall(Along::Y, [0.0, south], LIVING_ROOM_WALL_X_M, [materials.bedroom, materials.living]),
        &[],
    );
    build.partition(
        &wall(Along::Y, [south, north], LIVING_ROOM_WALL_X_M, [materials.hall, materials.living]),
        &[4.3],
    );
    build.partition(
        &wall(Along::Y, [north, FLAT_SIZE_M[1]], LIVING_ROOM_WALL_X_M, [materials.study, materials.kitchen]),
        &[],
    );
    let half = DOOR_WIDTH / 2.0;
    let hinges = [
        Pose2::new(4.4 + half + 0.03, south - 0.02, -FRAC_PI_2),
        Pose2::new(1.3 - half - 0.03, north + WALL_THICKNESS_M + 0.02, FRAC_PI_2),
        Pose2::new(4.3 + half + 0.03, north + WALL_THICKNESS_M + 0.02, FRAC_PI_2),
    ];
    for hinge in hinges {
        let swing = build.jitter(0.06);
        build.door_leaf(Pose2::new(hinge.x, hinge.y, hinge.theta + swing), [190, 160, 120]);
    }
}

fn bedroom(build: &mut Builder) {
    let along = build.jitter(0.08);
    build.bed(Pose2::new(1.1, 1.6 + along, 0.0), [2.05, 1.5, 0.5]);
    for y in [0.5, 2.75] {
        build.cabinet(Pose2::new(0.26, y + along, 0.0), [0.42, 0.42, 0.5]);
    }
    let color = build.choose(&[[206, 196, 178], [150, 120, 92], [186, 190, 186]]);
    build.fitted(Pose2::new(4.2, 0.32, FRAC_PI_2), [0.6, 2.0, 2.1], color);
    build.rug(Pose2::new(3.0, 1.8, 0.0), (1.2, 1.6));
    let chair = build.jittered(Pose2::new(5.15, 1.6, PI), 0.05, 0.3);
    build.chair(chair, [0.45, 0.45, 0.88]);
    build.window(Pose2::new(0.0, 1.6, 0.0), (1.6, 1.2));
    build.board(
        Pose2::new(1.9, HALL_FACES_Y_M[0] - WALL_THICKNESS_M, -FRAC_PI_2),
        1.5,
        (0.9, 0.7),
        Paint::Print,
    );
    build.plant(Pose2::new(2.75, 0.4, 0.0));
}

fn bath(build: &mut Builder) {
    build.tub(Pose2::new(0.92, 7.6, 0.0), [1.75, 0.75, 0.58]);
    build.toilet(Pose2::new(0.4, 6.55, 0.0));
    build.basin(Pose2::new(BATH_WALL_X_M - 0.25, 6.3, PI));
    build.board(Pose2::new(BATH_WALL_X_M, 6.3, PI), 1.5, (0.6, 0.8), Paint::Screen);
    build.washer(Pose2::new(BATH_WALL_X_M - 0.32, 7.62, PI));
}

fn study(build: &mut Builder) {
    let along = build.jitter(0.1);
    build.desk(Pose2::new(4.4 + along, FLAT_SIZE_M[1] - 0.38, -FRAC_PI_2), (0.7, 1.5));
    let chair = build.jittered(Pose2::new(4.4, 6.9, FRAC_PI_2), 0.06, 0.5);
    build.chair(chair, [0.46, 0.46, 0.92]);
    build.bookcase(Pose2::new(BATH_WALL_X_M + WALL_THICKNESS_M + 0.17, 6.9, FRAC_PI_2), [1.8, 0.32, 2.0]);
    let place = build.jittered(Pose2::new(3.05, 5.35, 0.0), 0.04, 0.2);
    build.cartons(place, [0.5, 0.42, 0.4]);
    build.bin(Pose2::new(5.25, 7.75, 0.0));
}

fn hall(build: &mut Builder) {
    build.closed_door(Pose2::new(0.0, 4.3, 0.0), [110, 74, 52]);
    let along = build.jitter(0.15);
    build.fitted(
        Pose2::new(2.3 + along, HALL_FACES_Y_M[0] + 0.13, FRAC_PI_2),
        [0.24, 1.1, 0.95],
        [196, 186, 166],
    );
    build.board(Pose2::new(2.3 + along, HALL_FACES_Y_M[0], FRAC_PI_2), 1.55, (0.7, 0.9), Paint::Print);
    build.board(Pose2::new(2.7, HALL_FACES_Y_M[1], -FRAC_PI_2), 1.5, (0.8, 0.6), Paint::Print);
}

fn living(build: &mut Builder) {
    let west = LIVING_ROOM_WALL_X_M + WALL_THICKNESS_M;
    let along = build.jitter(0.1);
    build.rug(Pose2::new(7.3, 1.7, 0.0), (1.9, 2.3));
    build.sofa(Pose2::new(west + 0.47, 1.7 + along, 0.0), [0.9, 2.1, 0.82]);
    let place = build.jittered(Pose2::new(7.3, 1.7, 0.0), 0.06, 0.1);
    build.table(place, [0.6, 1.1, 0.42]);
    build.cabinet(Pose2::new(FLAT_SIZE_M[0] - 0.25, 1.7 + along, 0.0), [0.44, 1.7, 0.5]);
    build.board(Pose2::new(FLAT_SIZE_M[0], 1.7 + along, PI), 1.1, (1.25, 0.72), Paint::Screen);
    build.bookcase(Pose2::new(8.1 + along, 0.17, PI), [1.6, 0.32, 2.0]);
    build.floor_lamp(Pose2::new(west + 0.3, 0.35, 0.0));
    build.plant(Pose2::new(FLAT_SIZE_M[0] - 0.4, 0.45, 0.0));
    let dining = build.jittered(Pose2::new(9.1, 3.85, 0.0), 0.03, 0.03);
    build.table(dining, [0.85, 1.3, 0.74]);
    for (x, y, heading) in [(-0.55, 0.3, 0.0), (-0.55, -0.3, 0.0), (0.5, 0.3, PI), (0.5, -0.3, PI)] {
        let chair = build.jittered(dining * Pose2::new(x, y, heading), 0.02, 0.15);
        build.chair(chair, [0.44, 0.44, 0.9]);
    }
    build.window(Pose2::new(6.6, 0.0, FRAC_PI_2), (1.2, 1.2));
}

fn kitchen(build: &mut Builder) {
    let color = build.choose(&[[206, 198, 180], [92, 116, 120], [176, 150, 116], [186, 74, 62]]);
    build.counter(Pose2::new(7.5, FLAT_SIZE_M[1] - 0.32, -FRAC_PI_2), [0.6, 2.7, 0.92], color);
    build.counter(
        Pose2::new(LIVING_ROOM_WALL_X_M + WALL_THICKNESS_M + 0.32, 6.9, 0.0),
        [0.6, 2.1, 0.92],
        color,
    );
    build.fridge(Pose2::new(9.3, FLAT_SIZE_M[1] - 0.34, -FRAC_PI_2));
    build.window(Pose2::new(7.2, FLAT_SIZE_M[1], -FRAC_PI_2), (1.3, 1.0));
    let table = build.jittered(Pose2::new(9.35, 6.1, 0.0), 0.03, 0.04);
    build.table(table, [0.75, 0.9, 0.74]);
    let chair = build.jittered(Pose2::new(8.85, 6.1, 0.0), 0.04, 0.3);
    build.chair(chair, [0.42, 0.42, 0.86]);
    build.bin(Pose2::new(9.75, 5.25, 0.0));
}

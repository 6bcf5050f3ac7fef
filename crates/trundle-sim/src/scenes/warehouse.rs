//! Scene: a warehouse with racks, aisles and goods.

use super::Scene;
use super::builder::{Builder, Side};
use super::storage::PALLET_HEIGHT_M;
use crate::materials::{Finish, Paint};
use crate::world::{Lights, World};
use std::f64::consts::{FRAC_PI_2, PI};
use trundle_core::{Invalid, Pose2};

/// Inner side of the hall and its height, m. Source: ours.
const HALL_SIDE_M: f64 = 30.0;
const HALL_HEIGHT_M: f64 = 5.5;

/// Middles of the double rows of racks, x, m: aisles of 2.8 m between them. Source: ours.
const ROW_CENTRES_X_M: [f64; 4] = [4.6, 10.0, 15.4, 20.8];

/// Start of the racks along y, number and length of their bays, m. Source: ours.
const FIRST_BAY_Y_M: f64 = 5.0;
const BAYS_PER_RACK: usize = 7;
const BAY_LENGTH_M: f64 = 2.7;

/// Depth of a rack, and from a double row's middle to the middles of its two racks, m. Source: ours.
const RACK_DEPTH_M: f64 = 1.1;
const HALF_RACK_SPACING_M: f64 = 0.65;

/// Heights of the shelves, m. Source: ours.
const SHELF_HEIGHTS_M: [f64; 2] = [1.7, 3.3];

const STEEL: Paint = Paint::Slotted { color: [38, 72, 128] };
const BEAM: Finish = Finish { faces: [Paint::Flat { color: [214, 104, 30] }; 6], seed: Some(11) };
const YELLOW: Paint = Paint::Marking { color: [226, 188, 44] };

/// A warehouse, 30 x 30 m and 5.5 m high (world frame: x and y 0 to 30).
///
/// Four double rows of pallet racks with aisles of 2.8 m, concrete columns, an open area in the east with pallets, drums and cartons before
/// the gates. Goods, signs and uprights have much texture, concrete and corrugated walls have little, and goods repeat. `seed` varies
/// textures and colours, the goods in the racks, and the pallets on the floor.
///
/// # Errors
/// None for any seed; the result type is that of all scenes.
pub fn warehouse(seed: u64) -> Result<Scene, Invalid> {
    let mut build = Builder::new(seed);
    shell(&mut build);
    columns(&mut build);
    for (nth, x) in ROW_CENTRES_X_M.into_iter().enumerate() {
        for side in [-1.0, 1.0] {
            rack(&mut build, x + side * HALF_RACK_SPACING_M, side);
        }
        row_ends(&mut build, x, nth);
    }
    markings(&mut build);
    open_area(&mut build);
    Ok(Scene {
        name: "warehouse".into(),
        world: World::new(build.solids, seed)?,
        lights: Lights::default(),
        people: Vec::new(),
        start: Pose2::new(1.4, 2.4, FRAC_PI_2),
        goal: Pose2::new(26.4, 26.6, 0.0),
        station: None,
    })
}

fn shell(build: &mut Builder) {
    let thick = 0.2;
    let (low, high) = (-thick, HALL_SIDE_M + thick);
    let floor = Paint::Concrete { color: [148, 146, 140] };
    let sheets =
        Paint::Corrugated { color: build.choose(&[[176, 184, 190], [188, 184, 170], [164, 176, 168]]) };
    build.slab([low, low, -0.1], [high, high, 0.0], &[(Side::Top, floor)]);
    build.slab(
        [low, low, HALL_HEIGHT_M],
        [high, high, HALL_HEIGHT_M + 0.1],
        &[(Side::Bottom, Paint::Ceiling)],
    );
    build.slab([low, low, 0.0], [0.0, high, HALL_HEIGHT_M], &[(Side::East, sheets)]);
    build.slab([HALL_SIDE_M, low, 0.0], [high, high, HALL_HEIGHT_M], &[(Side::West, sheets)]);
    build.slab([0.0, low, 0.0], [HALL_SIDE_M, 0.0, HALL_HEIGHT_M], &[(Side::North, sheets)]);
    build.slab([0.0, HALL_SIDE_M, 0.0], [HALL_SIDE_M, high, HALL_HEIGHT_M], &[(Side::South, sheets)]);
    for x in [3.0, 9.0, 15.0, 21.0] {
        let place = build.jittered(Pose2::new(x, 0.0, FRAC_PI_2), 0.0, 0.0);
        build.board(place, 1.7, (1.4, 1.0), Paint::Print);
        build.board(
            Pose2::new(x + 2.5, HALL_SIDE_M, -FRAC_PI_2),
            1.9,
            (0.9, 0.6),
            Paint::Sign { color: [30, 110, 60] },
        );
    }
}

/// Columns in the middle of the double rows' ends and in the open area, each with its number.
fn columns(build: &mut Builder) {
    let concrete = Finish::all(Paint::Concrete { color: [170, 168, 160] }).seeded(21);
    let in_rows = ROW_CENTRES_X_M.into_iter().flat_map(|x| [(x, 3.2), (x, 26.2)]);
    for (x, y) in in_rows.chain([(25.8, 9.0), (25.8, 20.0)]) {
        let place = Pose2::new(x, y, 0.0);
        build.block(place, (0.0, 0.0), 0.0, [0.4, 0.4, HALL_HEIGHT_M], concrete.clone());
        for heading in [0.0, FRAC_PI_2, PI, -FRAC_PI_2] {
            let face = Pose2::new(x, y, heading) * Pose2::new(0.2, 0.0, 0.0);
            build.board(face, 1.5, (0.32, 0.24), Paint::Sign { color: [40, 60, 130] });
        }
    }
}

/// A rack along y with its middle at `x`; `side` is +1 for goods that face east.
fn rack(build: &mut Builder, x: f64, side: f64) {
    for frame in 0..=BAYS_PER_RACK {
        let place = Pose2::new(x, FIRST_BAY_Y_M + BAY_LENGTH_M * frame as f64, 0.0);
        let post = Finish::all(STEEL).seeded(10);
        for across in [-1.0, 1.0] {
            let offset = (across * (RACK_DEPTH_M / 2.0 - 0.05), 0.0);
            build.block(place, offset, 0.0, [0.1, 0.09, 4.6], post.clone());
        }
    }
    for bay in 0..BAYS_PER_RACK {
        let place = Pose2::new(
            x,
            FIRST_BAY_Y_M + BAY_LENGTH_M * (bay as f64 + 0.5),
            if side > 0.0 { 0.0 } else { PI },
        );
        for shelf in SHELF_HEIGHTS_M {
            build.block(place, (0.0, 0.0), shelf - 0.12, [RACK_DEPTH_M, BAY_LENGTH_M - 0.1, 0.12], BEAM);
        }
        floor_bay(build, place);
        for shelf in SHELF_HEIGHTS_M {
            shelf_bay(build, place, shelf);
        }
    }
}

/// Two places for pallets on the floor under the lowest shelf.
fn floor_bay(build: &mut Builder, place: Pose2) {
    for along in [-0.62, 0.62] {
        if build.happens(0.8) {
            let pallet = place * Pose2::new(0.0, along + build.jitter(0.04), build.jitter(0.02));
            let height = build.choose(&[PALLET_HEIGHT_M, 0.9, 1.2, 1.4]);
            build.loaded_pallet(pallet, [0.95, 1.1, height]);
        }
    }
}

/// Goods on a shelf.
fn shelf_bay(build: &mut Builder, place: Pose2, shelf: f64) {
    for along in [-0.62, 0.62] {
        if build.happens(0.75) {
            let height = build.choose(&[0.6, 0.9, 1.2]);
            let across = build.jitter(0.03);
            build.goods(place, (across, along), shelf, [0.9, 1.05, height]);
        }
    }
}

/// Guards and an aisle's sign at both ends of a double row.
fn row_ends(build: &mut Builder, x: f64, nth: usize) {
    let last = FIRST_BAY_Y_M + BAY_LENGTH_M * BAYS_PER_RACK as f64;
    for (y, heading) in [(FIRST_BAY_Y_M - 0.25, -FRAC_PI_2), (last + 0.25, FRAC_PI_2)] {
        for across in [-1.1, 1.1] {
            build.guard(Pose2::new(x + across, y, 0.0));
        }
        let color = [[176, 44, 40], [36, 110, 66], [40, 74, 150], [150, 96, 20]][nth % 4];
        let sign = Pose2::new(x, y, heading) * Pose2::new(-0.2, 0.0, 0.0);
        build.board(sign, 2.2, (1.0, 0.7), Paint::Sign { color });
    }
}

/// Painted lines along the aisles and around the open area, 1 mm thick.
fn markings(build: &mut Builder) {
    let last = FIRST_BAY_Y_M + BAY_LENGTH_M * BAYS_PER_RACK as f64;
    let line = |[x0, y0, x1, y1]: [f64; 4]| ([x0, y0, 0.0], [x1, y1, 0.001], [(Side::Top, YELLOW)]);
    for x in ROW_CENTRES_X_M.into_iter().flat_map(|x| [x - 1.35, x + 1.35]) {
        let (low, high, seen) = line([x - 0.05, FIRST_BAY_Y_M - 0.6, x + 0.05, last + 0.6]);
        build.slab(low, high, &seen);
    }
    for rectangle in [[1.0, 0.9, 29.0, 1.0], [1.0, 28.9, 29.0, 29.0], [23.4, 4.4, 23.5, 25.0]] {
        let (low, high, seen) = line(rectangle);
        build.slab(low, high, &seen);
    }
    for stripe in 0..6 {
        let y = 13.0 + 0.8 * f64::from(stripe);
        let (low, high, seen) = line([28.0, y, 29.6, y + 0.4]);
        build.slab(low, high, &seen);
    }
}

/// Gates in the east wall, and before them pallets, drums and cartons.
fn open_area(build: &mut Builder) {
    for y in [7.0, 15.0, 23.0] {
        let gate = Paint::Corrugated { color: [214, 120, 40] };
        build.board(Pose2::new(HALL_SIDE_M, y, PI), 1.8, (3.2, 3.6), gate);
        build.board(
            Pose2::new(HALL_SIDE_M, y + 2.2, PI),
            2.0,
            (0.7, 0.9),
            Paint::Sign { color: [30, 60, 120] },
        );
    }
    for (x, y) in
        [(24.8, 6.2), (27.4, 5.2), (25.2, 12.3), (27.8, 11.0), (25.0, 16.8), (27.2, 19.0), (25.3, 23.2)]
    {
        let place = build.jittered(Pose2::new(x, y, 0.0), 0.2, 0.6);
        let height = build.choose(&[PALLET_HEIGHT_M, 0.7, 1.1, 1.5]);
        build.loaded_pallet(place, [1.2, 0.8, height]);
    }
    for (x, y) in [(29.3, 2.0), (28.6, 2.1), (29.2, 2.8), (29.3, 28.0)] {
        build.drum(Pose2::new(x, y, 0.0), 0.0);
    }
    for (x, y) in [(0.5, 28.9), (13.0, 0.5), (18.6, 0.45), (7.2, 29.4)] {
        let place = build.jittered(Pose2::new(x, y, 0.0), 0.05, 0.4);
        build.cartons(place, [0.7, 0.55, 0.55]);
    }
}

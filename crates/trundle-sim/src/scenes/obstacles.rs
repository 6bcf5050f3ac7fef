//! Scene: a room with obstacles after \[Li18\].

use super::Scene;
use super::builder::{Builder, Side, WALL_THICKNESS_M};
use crate::materials::Paint;
use crate::world::{Lights, World};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use trundle_core::{Invalid, Pose2};

/// Inner side of the room, m. Source: ours.
const ROOM_SIDE_M: f64 = 6.0;

/// Middles of the obstacles, m. Their spacing leaves paths of 0.8 m between them for all headings. Source: ours.
const PLACES: [(f64, f64); 8] =
    [(1.95, 1.75), (3.35, 0.85), (4.75, 1.7), (0.9, 3.2), (3.05, 3.1), (4.7, 3.5), (1.9, 4.7), (3.6, 4.9)];

/// A square room, 6 x 6 m, to be crossed from corner to corner among cartons, cabinets and bins (world frame: 0 to 6).
///
/// After the room with obstacles of \[Li18\], section 5. `seed` varies textures, sizes, turns and, by 5 cm, places.
///
/// # Errors
/// None for any seed; the result type is that of all scenes.
pub fn obstacles(seed: u64) -> Result<Scene, Invalid> {
    let mut build = Builder::new(seed);
    walls(&mut build);
    for (i, (x, y)) in PLACES.into_iter().enumerate() {
        let place = build.jittered(Pose2::new(x, y, 0.0), 0.05, FRAC_PI_2);
        let (a, b) = (0.42 + build.jitter(0.06), 0.38 + build.jitter(0.06));
        match i % 4 {
            0 => build.cartons(place, [a, b, 0.45]),
            1 => build.carton(place, [a, b, 0.6]),
            2 => build.cabinet(place, [a, b, 0.9]),
            _ => build.bin(place),
        }
    }
    Ok(Scene {
        name: "obstacles".into(),
        world: World::new(build.solids, seed)?,
        lights: Lights::default(),
        people: Vec::new(),
        start: Pose2::new(0.7, 0.7, FRAC_PI_4),
        goal: Pose2::new(5.3, 5.2, FRAC_PI_2),
        station: None,
    })
}

fn walls(build: &mut Builder) {
    let (low, high) = (-WALL_THICKNESS_M, ROOM_SIDE_M + WALL_THICKNESS_M);
    build.floor_and_ceiling([low, low, high, high], Paint::Boards { color: [170, 140, 104] });
    let paper = Paint::Wallpaper { color: [180, 186, 170] };
    let plaster = |color| Paint::Plaster { color, prints: 0.75 };
    build.wall([low, low, 0.0, high], &[(Side::East, plaster([190, 176, 156]))]);
    build.wall([ROOM_SIDE_M, low, high, high], &[(Side::West, Paint::Bricks)]);
    build.wall([0.0, low, ROOM_SIDE_M, 0.0], &[(Side::North, paper)]);
    build.wall([0.0, ROOM_SIDE_M, ROOM_SIDE_M, high], &[(Side::South, plaster([170, 184, 196]))]);
}

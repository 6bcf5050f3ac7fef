//! Scene: the empty room of the point stabilisation of \[Li18\].

use super::Scene;
use super::builder::{Builder, Side, WALL_THICKNESS_M};
use crate::materials::Paint;
use crate::world::{Lights, World};
use std::f64::consts::FRAC_PI_2;
use trundle_core::{Invalid, Pose2};

/// Half of the room's inner side, m. Source: ours.
const HALF_SIDE_M: f64 = 3.0;

/// An empty room, 6 x 6 m, its middle the origin of the world frame: the scene of the point stabilisation of \[Li18\].
///
/// The goal is the one in \[Li18\], (0, 0, 90 deg). The start is the one of their eight that faces across the room, (-2.4, 2.4, 0). At the
/// other starts a Kobuki is 0.42 m from the wall, too. The walls have much texture. `seed` varies textures and colours.
///
/// # Errors
/// None for any seed; the result type is that of all scenes.
pub fn room(seed: u64) -> Result<Scene, Invalid> {
    let mut build = Builder::new(seed);
    let (low, high) = (-HALF_SIDE_M - WALL_THICKNESS_M, HALF_SIDE_M + WALL_THICKNESS_M);
    let wood = build.choose(&[[178, 134, 88], [150, 104, 66], [196, 160, 112]]);
    build.floor_and_ceiling([low, low, high, high], Paint::Boards { color: wood });
    let paper =
        Paint::Wallpaper { color: build.choose(&[[176, 190, 164], [196, 180, 150], [170, 172, 192]]) };
    let cool = Paint::Plaster { color: build.choose(&[[168, 184, 190], [180, 186, 170]]), prints: 0.75 };
    let warm = Paint::Plaster { color: build.choose(&[[204, 186, 160], [198, 176, 172]]), prints: 0.75 };
    build.wall([low, low, -HALF_SIDE_M, high], &[(Side::East, Paint::Bricks)]);
    build.wall([HALF_SIDE_M, low, high, high], &[(Side::West, paper)]);
    build.wall([-HALF_SIDE_M, low, HALF_SIDE_M, -HALF_SIDE_M], &[(Side::North, warm)]);
    build.wall([-HALF_SIDE_M, HALF_SIDE_M, HALF_SIDE_M, high], &[(Side::South, cool)]);
    Ok(Scene {
        name: "room".into(),
        world: World::new(build.solids, seed)?,
        lights: Lights::default(),
        people: Vec::new(),
        start: Pose2::new(-2.4, 2.4, 0.0),
        goal: Pose2::new(0.0, 0.0, FRAC_PI_2),
        station: None,
    })
}

//! Scenes: the narrow corridors of \[Hong24\].

use super::Scene;
use super::builder::{Builder, Side, WALL_THICKNESS_M};
use crate::materials::{Finish, Paint};
use crate::world::{Lights, World};
use std::f64::consts::FRAC_PI_2;
use trundle_core::{Invalid, Pose2};

/// Clear width, m. The paper's robot (0.6 x 0.4 m, 0.72 m across its corners) can turn round only in the middle; a Kobuki (0.351 m) can
/// turn anywhere. Source: ours, after \[Hong24\].
const CORRIDOR_WIDTH_M: f64 = 1.0;

/// Half of the corridor's length, m. Source: ours.
const HALF_LENGTH_M: f64 = 3.0;

/// Distance of the robot's start to the left of the goal, m. Source: ours.
const START_OFFSET_M: f64 = 0.38;

/// The corridors of \[Hong24\], section 4.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corridor {
    /// (a) Free, the goal to the right.
    Free,
    /// (b) Blocked in front, the goal to the right.
    FrontBlocked,
    /// (c) Blocked in front on the left, the goal to the right.
    LeftFrontBlocked,
    /// (d) Blocked in front on the right, the goal to the right and behind.
    RightFrontBlocked,
}

/// A corridor 1.0 m wide and 6 m long for docking, closed at both ends (world frame: origin in its middle, y along it).
///
/// The goal faces along the corridor. The robot starts 0.38 m to the left of the goal with the same heading; a crate 1.1 m high blocks the
/// straight path. Both poses are free for a Kobuki and for a robot of 0.6 x 0.4 m. `seed` varies textures and, by 2 cm, the crate.
///
/// # Errors
/// None for any seed; the result type is that of all scenes.
pub fn corridor(kind: Corridor, seed: u64) -> Result<Scene, Invalid> {
    let mut build = Builder::new(seed);
    shell(&mut build);
    let ahead = 0.44 + build.jitter(0.02);
    let half = CORRIDOR_WIDTH_M / 2.0;
    match kind {
        Corridor::Free => {}
        Corridor::FrontBlocked => crate_over(&mut build, [-half, half], ahead),
        Corridor::LeftFrontBlocked => crate_over(&mut build, [-half, -0.05], ahead),
        Corridor::RightFrontBlocked => crate_over(&mut build, [0.05, half], ahead),
    }
    let back = if kind == Corridor::RightFrontBlocked { 0.5 } else { 0.0 };
    let (name, x) = (kind.name(), START_OFFSET_M / 2.0);
    Ok(Scene {
        name: name.into(),
        world: World::new(build.solids, seed)?,
        lights: Lights::default(),
        people: Vec::new(),
        start: Pose2::new(-x, 0.0, FRAC_PI_2),
        goal: Pose2::new(x, -back, FRAC_PI_2),
        station: None,
    })
}

impl Corridor {
    /// The scene's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Free => "corridor-a",
            Self::FrontBlocked => "corridor-b",
            Self::LeftFrontBlocked => "corridor-c",
            Self::RightFrontBlocked => "corridor-d",
        }
    }
}

fn shell(build: &mut Builder) {
    let half = CORRIDOR_WIDTH_M / 2.0;
    let (out, end) = (half + WALL_THICKNESS_M, HALF_LENGTH_M + WALL_THICKNESS_M);
    build.floor_and_ceiling([-out, -end, out, end], Paint::Tiles { color: [176, 170, 158] });
    let left = Paint::Plaster { color: build.choose(&[[196, 188, 170], [176, 186, 180]]), prints: 0.7 };
    let right = Paint::Wallpaper { color: build.choose(&[[188, 180, 160], [170, 176, 190]]) };
    build.wall([-out, -end, -half, end], &[(Side::East, left)]);
    build.wall([half, -end, out, end], &[(Side::West, right)]);
    build.wall([-half, HALF_LENGTH_M, half, end], &[(Side::South, Paint::Bricks)]);
    build.wall([-half, -end, half, -HALF_LENGTH_M], &[(Side::North, Paint::Bricks)]);
}

/// A crate over `across` (x, m), its near side `ahead` of the origin.
fn crate_over(build: &mut Builder, [low, high]: [f64; 2], ahead: f64) {
    let size = [high - low, 0.5, 1.1];
    let place = Pose2::new((low + high) / 2.0, ahead + size[1] / 2.0, 0.0);
    build.block(place, (0.0, 0.0), 0.0, size, Finish::all(Paint::Cardboard));
}

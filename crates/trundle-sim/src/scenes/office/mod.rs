//! Scene: an office with a ring corridor and look-alike rooms.

mod corridor;
mod layout;
mod rooms;

pub use layout::{OFFICE_RING, OFFICE_TWINS};

use super::Scene;
use super::builder::Builder;
use layout::{DOOR_CENTRE_X_M, NORTH_ROOMS_Y_M, ROOM_SIZE_M};

use crate::rng::hash;
use crate::world::{Lights, World};
use std::f64::consts::PI;
use trundle_core::{Invalid, Pose2};

/// Six rooms, 5 x 4.5 m each, outside a ring corridor 1.56 m wide that runs 41.8 m around a closed core (world frame: x 0 to
/// 15, y 0 to 18.25).
///
/// South, from the west: an office, a pantry, a copy of the office; north: two equal meeting rooms and a store. Equal rooms are equal to
/// the last texel: an image cannot distinguish them. The doors (1.0 m) are open. The corridor has little texture between its posters, signs
/// and closed doors. `seed` varies textures, colours, furniture and wall decorations.
///
/// # Errors
/// None for any seed; the result type is that of all scenes.
pub fn office(seed: u64) -> Result<Scene, Invalid> {
    let mut build = Builder::new(seed);
    corridor::place(&mut build);
    let [offices, meetings] = OFFICE_TWINS;
    for [x, y] in offices {
        build.alike(hash(seed, 1), |build| rooms::office(build, Pose2::new(x, y, 0.0)));
    }
    for [x, y] in meetings {
        build.alike(hash(seed, 2), |build| rooms::meeting(build, Pose2::new(x, y, 0.0)));
    }
    rooms::pantry(&mut build, Pose2::new(ROOM_SIZE_M[0], 0.0, 0.0));
    rooms::store(&mut build, Pose2::new(2.0 * ROOM_SIZE_M[0], NORTH_ROOMS_Y_M, 0.0));
    Ok(Scene {
        name: "office".into(),
        world: World::new(build.solids, seed)?,
        lights: Lights::default(),
        people: Vec::new(),
        start: Pose2::new(2.0, OFFICE_RING[0][1], 0.0),
        goal: Pose2::new(5.0 + DOOR_CENTRE_X_M, NORTH_ROOMS_Y_M + 1.2, PI),
        station: None,
    })
}

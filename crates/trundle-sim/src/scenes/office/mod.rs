//! Scene: an office with a ring corridor and look-alike rooms.

mod corridor;
mod rooms;

use super::Scene;
use super::builder::Builder;
use crate::rng::hash;
use crate::world::{Lights, World};
use std::f64::consts::PI;
use trundle_core::{Invalid, Pose2};

/// Half of the thickness of walls between rooms and the corridor, m. All measures of the office are sums of few powers of
/// two, so that a room placed elsewhere is the same to the last bit.
const HALF_WALL: f64 = 0.0625;

/// Outer size of a room, m.
const ROOM_SIZE_M: [f64; 2] = [5.0, 4.5];

/// Middle of a room's door, from its west side, m.
const DOOR_CENTRE_X_M: f64 = 3.75;

/// The closed core inside the ring: low and high corner, m.
const CORE: [[f64; 2]; 2] = [[1.625, 6.125], [13.375, 12.125]];

/// South side of the northern rooms, m.
const NORTH_ROOMS_Y_M: f64 = 13.75;

/// Way-points around the office's ring corridor, its centre line, m: 41.8 m around.
pub const OFFICE_RING: [[f64; 2]; 4] =
    [[0.84375, 5.34375], [14.15625, 5.34375], [14.15625, 12.90625], [0.84375, 12.90625]];

/// Corresponding places of the office's look-alike rooms, m: the south-west corners of two equal offices, and of two equal
/// meeting rooms.
pub const OFFICE_TWINS: [[[f64; 2]; 2]; 2] =
    [[[0.0, 0.0], [10.0, 0.0]], [[0.0, NORTH_ROOMS_Y_M], [5.0, NORTH_ROOMS_Y_M]]];

/// Six rooms, 5 x 4.5 m each, outside a ring corridor 1.56 m wide that runs 41.8 m around a closed core (world frame: x 0 to
/// 15, y 0 to 18.25).
///
/// South, from the west: an office, a pantry, the same office again; north: two equal meeting rooms and a store. Rooms
/// that are equal are so to the last texel: what one looks like says nothing about which it is. The doors (1.0 m) stand
/// open. The corridor is poor in texture between its posters, signs and closed doors. `seed` varies textures, colours,
/// furniture and what hangs on the walls.
///
/// # Errors
/// Never for any seed; the type is that of every scene.
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
    })
}

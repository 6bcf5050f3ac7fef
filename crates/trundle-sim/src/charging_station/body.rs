//! The station's box.

use crate::materials::{Finish, Paint};
use crate::solid::Solid;
use crate::world::{Cuboid, Shape};
use trundle_core::{Pose2, Vector2, Vector3};

/// Depth, width and height of the box \[m\]: low enough for a camera above it, higher than the base's step height. Source: ours.
const BOX_SIZE_M: [f64; 3] = [0.08, 0.24, 0.1];
/// Colour of the box. Source: ours.
const BOX_COLOR: [u8; 3] = [58, 58, 64];

/// The box of a station at `world_from_station`.
pub(crate) fn station_box(station: Pose2) -> Solid {
    let [depth, _, height] = BOX_SIZE_M;
    let middle = station.transform(Vector2::new(-depth / 2.0, 0.0));
    let center = Vector3::new(middle.x, middle.y, height / 2.0);
    let shape = Shape::Cuboid(Cuboid { center, size: Vector3::from(BOX_SIZE_M), yaw: station.theta });
    Solid { shape, finish: Finish::all(Paint::Flat { color: BOX_COLOR }) }
}

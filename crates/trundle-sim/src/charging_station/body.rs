//! The station's box as part of a scene.

use crate::materials::{Finish, Paint};
use crate::scenes::Scene;
use crate::solid::Solid;
use crate::world::{Cuboid, Shape};
use trundle_core::{Invalid, Pose2, Vector2, Vector3};

/// Depth, width and height of the box \[m\]: low enough for a camera above it, higher than what the base rolls over. Source: ours.
const BOX_SIZE_M: [f64; 3] = [0.08, 0.24, 0.1];
/// Colour of the box. Source: ours.
const BOX_COLOR: [u8; 3] = [58, 58, 64];

impl Scene {
    /// The scene with a charging station, `world_from_station`: on the floor at the middle of its front, x out of the front.
    ///
    /// # Errors
    /// When the pose is not finite.
    pub fn with_station(self, station: Pose2) -> Result<Self, Invalid> {
        let world = self.world.with_solid(station_box(station))?;
        Ok(Self { world, station: Some(station), ..self })
    }
}

fn station_box(station: Pose2) -> Solid {
    let [depth, _, height] = BOX_SIZE_M;
    let middle = station.transform(Vector2::new(-depth / 2.0, 0.0));
    let center = Vector3::new(middle.x, middle.y, height / 2.0);
    let shape = Shape::Cuboid(Cuboid { center, size: Vector3::from(BOX_SIZE_M), yaw: station.theta });
    Solid { shape, finish: Finish::all(Paint::Flat { color: BOX_COLOR }) }
}

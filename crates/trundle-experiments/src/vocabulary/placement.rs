//! Camera placements in a world, drawn with a seed at poses with clearance.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_app::AppError;
use trundle_core::{Footprint, Pose2, Pose3};
use trundle_sim::{HeightBand, Obstacles, World, camera_mount};

/// Radius of the robot that carries the camera \[m\]. A placement with less clearance is not drawn. Source: ours.
const CARRIER_RADIUS_M: f64 = 0.2;

/// Heights of the cameras \[m\]. Source: ours.
const CAMERA_HEIGHTS_M: std::ops::Range<f64> = 0.2..1.5;

/// Downward tilts of the cameras \[rad\]. Source: ours.
const CAMERA_TILTS_RAD: std::ops::Range<f64> = -0.3..0.3;

/// Lower limit of the obstacle height band \[m\]. Source: ours.
const OBSTACLE_LOW_M: f64 = 0.05;
/// Upper limit of the obstacle height band \[m\]. Source: ours.
const OBSTACLE_HIGH_M: f64 = 1.6;

/// Offset of a second view from the first, along x and along y \[m\]. Source: ours.
const MAX_SECOND_VIEW_OFFSET_M: f64 = 0.5;
/// Turn of a second view from the first \[rad\]. Source: ours.
const MAX_SECOND_VIEW_TURN_RAD: f64 = 20.0 / 180.0 * std::f64::consts::PI;

/// Maximum number of attempts for one placement with clearance. After these the world counts as full. Source: ours.
const MAX_DRAWN_PLACEMENTS: usize = 10_000;

/// Draws camera placements in a world.
pub struct PlacementSampler {
    obstacles: Obstacles,
    footprint: Footprint,
    /// Lowest and highest corner of the world.
    corners: [[f64; 2]; 2],
    rng: ChaCha8Rng,
}

/// A camera on a robot.
#[derive(Debug, Clone, Copy)]
pub struct CameraPlacement {
    base: Pose2,
    height: f64,
    tilt: f64,
}

impl CameraPlacement {
    /// `world_from_camera`.
    pub fn camera(&self) -> Pose3 {
        Pose3::from_pose2(self.base) * camera_mount(0.0, self.height, self.tilt)
    }
}

impl PlacementSampler {
    /// The placements of a world: equal seeds give equal placements in equal order.
    pub fn of(world: &World, seed: u64) -> Result<Self, AppError> {
        let (low, high) = world.bounds();
        Ok(Self {
            obstacles: world.obstacles(HeightBand::new(OBSTACLE_LOW_M, OBSTACLE_HIGH_M)?),
            footprint: Footprint::disc(CARRIER_RADIUS_M)?,
            corners: [[low.x, low.y], [high.x, high.y]],
            rng: ChaCha8Rng::seed_from_u64(seed),
        })
    }

    /// A placement with clearance; `None` if nearly the whole world is occupied.
    pub fn draw(&mut self) -> Option<CameraPlacement> {
        let [low, high] = self.corners;
        (0..MAX_DRAWN_PLACEMENTS).find_map(|_| {
            let x = self.rng.random_range(low[0]..=high[0]);
            let y = self.rng.random_range(low[1]..=high[1]);
            let heading = self.rng.random_range(-std::f64::consts::PI..std::f64::consts::PI);
            let (height, tilt) =
                (self.rng.random_range(CAMERA_HEIGHTS_M), self.rng.random_range(CAMERA_TILTS_RAD));
            let placement = CameraPlacement { base: Pose2::new(x, y, heading), height, tilt };
            self.is_free(placement).then_some(placement)
        })
    }

    /// A placement near another, for a second view by the same camera.
    pub fn near(&mut self, placement: CameraPlacement) -> CameraPlacement {
        let drawn = (0..MAX_DRAWN_PLACEMENTS).find_map(|_| {
            let mut offset = |limit: f64| self.rng.random_range(-limit..=limit);
            let (x, y, heading) = (
                offset(MAX_SECOND_VIEW_OFFSET_M),
                offset(MAX_SECOND_VIEW_OFFSET_M),
                offset(MAX_SECOND_VIEW_TURN_RAD),
            );
            let base = Pose2::new(placement.base.x + x, placement.base.y + y, placement.base.theta + heading);
            let near = CameraPlacement { base, ..placement };
            self.is_free(near).then_some(near)
        });
        drawn.unwrap_or(placement)
    }

    fn is_free(&self, placement: CameraPlacement) -> bool {
        self.obstacles.clearance(&self.footprint, placement.base) > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_sim::Scene;

    #[test]
    fn placements_are_free_and_second_views_are_near() {
        let scene = Scene::by_name("room", 3).unwrap();
        let mut sampler = PlacementSampler::of(&scene.world, 7).unwrap();
        for _ in 0..50 {
            let placement = sampler.draw().unwrap();
            let near = sampler.near(placement);
            assert!(sampler.is_free(placement) && sampler.is_free(near));
            let apart = placement.camera().inverse() * near.camera();
            assert!(apart.translation.norm() <= 0.71 && apart.angle() <= 0.35, "{apart:?}");
            assert_eq!(placement.camera().translation.z, near.camera().translation.z);
        }
        let again = PlacementSampler::of(&scene.world, 7).unwrap().draw().unwrap();
        assert_eq!(again.camera(), PlacementSampler::of(&scene.world, 7).unwrap().draw().unwrap().camera());
    }
}

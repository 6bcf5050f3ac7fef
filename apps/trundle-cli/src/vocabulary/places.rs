use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle::app::AppError;
use trundle::core::{Footprint, Pose2, Pose3};
use trundle::sim::{HeightBand, Obstacles, World, camera_mount};

/// Room around a camera, m: a robot carries it.
const ROOM: f64 = 0.2;

/// Heights of the cameras, m.
const HEIGHTS: std::ops::Range<f64> = 0.2..1.5;

/// Downward tilts of the cameras, rad.
const TILTS: std::ops::Range<f64> = -0.3..0.3;

/// What may be in the way of a robot, m above the floor.
const IN_THE_WAY: (f64, f64) = (0.05, 1.6);

/// How far a second look at a place is from the first at most, m along x and y and rad.
const NEARBY: (f64, f64) = (0.5, 20.0 / 180.0 * std::f64::consts::PI);

/// Places drawn for one with room, at most.
const MOST_DRAWN: usize = 10_000;

/// Where a camera may be in a world, by chance.
pub struct Places {
    obstacles: Obstacles,
    footprint: Footprint,
    /// Lowest and highest corner of the world.
    corners: [[f64; 2]; 2],
    rng: ChaCha8Rng,
}

/// A camera on a robot.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    base: Pose2,
    height: f64,
    tilt: f64,
}

impl Place {
    /// `world_from_camera`.
    pub fn camera(&self) -> Pose3 {
        Pose3::from_pose2(self.base) * camera_mount(0.0, self.height, self.tilt)
    }
}

impl Places {
    /// The places of a world, the same ones in the same order for the same seed.
    pub fn of(world: &World, seed: u64) -> Result<Self, AppError> {
        let (low, high) = world.bounds();
        Ok(Self {
            obstacles: world.obstacles(HeightBand::new(IN_THE_WAY.0, IN_THE_WAY.1)?),
            footprint: Footprint::disc(ROOM)?,
            corners: [[low.x, low.y], [high.x, high.y]],
            rng: ChaCha8Rng::seed_from_u64(seed),
        })
    }

    /// A place with room; `None` where the world has hardly any.
    pub fn draw(&mut self) -> Option<Place> {
        let [low, high] = self.corners;
        (0..MOST_DRAWN).find_map(|_| {
            let x = self.rng.random_range(low[0]..=high[0]);
            let y = self.rng.random_range(low[1]..=high[1]);
            let heading = self.rng.random_range(-std::f64::consts::PI..std::f64::consts::PI);
            let (height, tilt) = (self.rng.random_range(HEIGHTS), self.rng.random_range(TILTS));
            let place = Place { base: Pose2::new(x, y, heading), height, tilt };
            self.has_room(place).then_some(place)
        })
    }

    /// A second look at a place: from nearby, by the same robot.
    pub fn near(&mut self, place: Place) -> Place {
        let drawn = (0..MOST_DRAWN).find_map(|_| {
            let mut offset = |most: f64| self.rng.random_range(-most..=most);
            let (x, y, heading) = (offset(NEARBY.0), offset(NEARBY.0), offset(NEARBY.1));
            let base = Pose2::new(place.base.x + x, place.base.y + y, place.base.theta + heading);
            let near = Place { base, ..place };
            self.has_room(near).then_some(near)
        });
        drawn.unwrap_or(place)
    }

    fn has_room(&self, place: Place) -> bool {
        self.obstacles.clearance(&self.footprint, place.base) > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle::sim::Scene;

    #[test]
    fn places_have_room_and_second_looks_are_near() {
        let scene = Scene::by_name("room", 3).unwrap();
        let mut places = Places::of(&scene.world, 7).unwrap();
        for _ in 0..50 {
            let place = places.draw().unwrap();
            let near = places.near(place);
            assert!(places.has_room(place) && places.has_room(near));
            let apart = place.camera().inverse() * near.camera();
            assert!(apart.translation.norm() <= 0.71 && apart.angle() <= 0.35, "{apart:?}");
            assert_eq!(place.camera().translation.z, near.camera().translation.z);
        }
        let again = Places::of(&scene.world, 7).unwrap().draw().unwrap();
        assert_eq!(again.camera(), Places::of(&scene.world, 7).unwrap().draw().unwrap().camera());
    }
}

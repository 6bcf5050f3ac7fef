//! A scene: a world with lights, people, start and goal.

use crate::charging_station::station_box;
use crate::people::Person;
use crate::world::{Lights, SceneSnapshot, World};
use trundle_core::{Invalid, Pose2};

/// A world with a start and a goal.
#[derive(Debug)]
pub struct Scene {
    /// The name, as in [`Scene::NAMES`].
    pub name: String,
    /// Solids and meshes.
    pub world: World,
    /// The lights.
    pub lights: Lights,
    /// People who walk.
    pub people: Vec<Person>,
    /// Start of the robot, `world_from_base`.
    pub start: Pose2,
    /// Goal of the robot, `world_from_base`.
    pub goal: Pose2,
    /// A charging station, `world_from_station`: see [`Scene::with_station`].
    pub station: Option<Pose2>,
}

impl Scene {
    /// The scene for a camera without moving objects.
    pub fn snapshot(&self) -> SceneSnapshot<'_> {
        SceneSnapshot { world: &self.world, movers: &[], lights: &self.lights }
    }

    /// The scene with a charging station, `world_from_station`: on the floor at the middle of its front, x out of the front.
    ///
    /// # Errors
    /// When the pose is not finite.
    pub fn with_station(self, station: Pose2) -> Result<Self, Invalid> {
        let world = self.world.with_solid(station_box(station))?;
        Ok(Self { world, station: Some(station), ..self })
    }

    /// The goal in a frame that starts at the robot: `start_from_goal`.
    pub fn start_from_goal(&self) -> Pose2 {
        self.start.inverse() * self.goal
    }
}

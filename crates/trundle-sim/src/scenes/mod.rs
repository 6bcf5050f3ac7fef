//! Built-in scenes, drawn by code from a seed.

mod builder;
mod demo_room;
mod furniture;
mod obstacles;

use crate::people::Person;
use crate::world::{Lights, Stage, World};
pub use demo_room::demo_room;
pub use obstacles::obstacles;
use trundle_core::{Invalid, Pose2};

/// A world with a task in it.
#[derive(Debug)]
pub struct Scene {
    /// Its name, as in [`Scene::NAMES`].
    pub name: String,
    /// What stands there.
    pub world: World,
    /// How it is lit.
    pub lights: Lights,
    /// Who walks about.
    pub people: Vec<Person>,
    /// Where the robot starts, `world_from_base`.
    pub start: Pose2,
    /// Where the robot shall go, `world_from_base`.
    pub goal: Pose2,
}

impl Scene {
    /// The built-in scenes.
    pub const NAMES: [&str; 2] = ["demo", "obstacles"];

    /// A built-in scene by its name; `room` is another name of `demo`.
    ///
    /// # Errors
    /// When there is no scene of that name.
    pub fn by_name(name: &str, seed: u64) -> Result<Self, Invalid> {
        match name {
            "demo" | "room" => demo_room(seed),
            "obstacles" => obstacles(seed),
            _ => Err(Invalid::new("scene", name, "", format!("one of {}", Self::NAMES.join(", ")))),
        }
    }

    /// What a camera sees of it while nothing moves.
    pub fn stage(&self) -> Stage<'_> {
        Stage { world: &self.world, movers: &[], lights: &self.lights }
    }

    /// The goal as the robot is given it, in a frame that starts at the robot: `start_from_goal`.
    pub fn start_from_goal(&self) -> Pose2 {
        self.start.inverse() * self.goal
    }
}

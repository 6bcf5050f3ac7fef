//! Built-in scenes, drawn by code from a seed.

mod builder;
mod corridors;
mod demo_room;
pub mod file;
mod fixtures;
mod furniture;
mod home;
mod house;
mod obstacles;
mod office;
mod partition;
mod room;
mod storage;
mod warehouse;

use crate::people::Person;
use crate::world::{Lights, SceneSnapshot, World};
pub use corridors::{Corridor, corridor};
pub use demo_room::demo_room;
pub use house::house;
pub use obstacles::obstacles;
pub use office::{OFFICE_RING, OFFICE_TWINS, office};
pub use room::room;
use trundle_core::{Invalid, Pose2};
pub use warehouse::warehouse;

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
    pub const NAMES: [&str; 10] = [
        "demo",
        "room",
        "obstacles",
        "corridor-a",
        "corridor-b",
        "corridor-c",
        "corridor-d",
        "office",
        "house",
        "warehouse",
    ];

    /// A built-in scene by its name.
    ///
    /// # Errors
    /// When there is no scene of that name.
    pub fn by_name(name: &str, seed: u64) -> Result<Self, Invalid> {
        match name {
            "demo" => demo_room(seed),
            "room" => room(seed),
            "obstacles" => obstacles(seed),
            "corridor-a" => corridor(Corridor::Free, seed),
            "corridor-b" => corridor(Corridor::FrontBlocked, seed),
            "corridor-c" => corridor(Corridor::LeftFrontBlocked, seed),
            "corridor-d" => corridor(Corridor::RightFrontBlocked, seed),
            "office" => office(seed),
            "house" => house(seed),
            "warehouse" => warehouse(seed),
            _ => Err(Invalid::new("scene", name, "", format!("one of {}", Self::NAMES.join(", ")))),
        }
    }

    /// What a camera sees of it while nothing moves.
    pub fn snapshot(&self) -> SceneSnapshot<'_> {
        SceneSnapshot { world: &self.world, movers: &[], lights: &self.lights }
    }

    /// The goal as the robot is given it, in a frame that starts at the robot: `start_from_goal`.
    pub fn start_from_goal(&self) -> Pose2 {
        self.start.inverse() * self.goal
    }
}

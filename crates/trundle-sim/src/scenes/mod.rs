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
mod plain_room;
mod room;
mod scene;
mod storage;
mod warehouse;

pub use corridors::{Corridor, corridor};
pub use demo_room::demo_room;
pub use house::house;
pub use obstacles::obstacles;
pub use office::{OFFICE_RING, OFFICE_TWINS, office};
pub use plain_room::plain_room;
pub use room::room;
pub use scene::Scene;
use trundle_core::Invalid;
pub use warehouse::warehouse;

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
    /// When no scene has this name.
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
}

//! Corridor problems: a generator, the four scenarios of \[Hong24\], and a text format. See `docs/algorithms/docking.md`.

mod answers;
mod format;
mod generate;
mod scenarios;

pub use answers::{Answer, Piece, parse_answers, time_of, write_answers};
pub use format::{parse, write};
pub use generate::generate;
pub use scenarios::Scenario;

use crate::scene::{Obstacle, Scene};
use trundle_core::{Footprint, Invalid, Pose2};

/// A robot beside its goal in a tight place.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// One word.
    pub name: String,
    /// The robot's outline.
    pub footprint: Footprint,
    /// `map_from_base` at the beginning.
    pub start: Pose2,
    /// `map_from_base` at the end.
    pub goal: Pose2,
    /// What stands around, map frame.
    pub obstacles: Vec<Obstacle>,
}

impl Problem {
    /// The obstacles, prepared.
    ///
    /// # Errors
    /// When one of them is not valid.
    pub fn scene(&self) -> Result<Scene, Invalid> {
        Scene::new(&self.obstacles)
    }
}

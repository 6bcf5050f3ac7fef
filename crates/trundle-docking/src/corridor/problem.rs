//! A corridor problem.

use crate::scene::obstacle_scene::{Obstacle, ObstacleScene};
use trundle_core::{Footprint, Invalid, Pose2};

/// A robot next to its goal in a narrow space.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Name of the problem, one word.
    pub name: String,
    /// The robot's footprint.
    pub footprint: Footprint,
    /// `map_from_base` at the start.
    pub start: Pose2,
    /// `map_from_base` at the goal.
    pub goal: Pose2,
    /// Obstacles, map frame.
    pub obstacles: Vec<Obstacle>,
}

impl Problem {
    /// The obstacles, indexed.
    ///
    /// # Errors
    /// When an obstacle is invalid.
    pub fn scene(&self) -> Result<ObstacleScene, Invalid> {
        ObstacleScene::new(&self.obstacles)
    }
}

//! A world with its moving solids at one time, for camera and laser.

use super::{Lights, Mover, World};

/// All that a camera or a laser may see at one moment.
#[derive(Debug, Clone, Copy)]
pub struct SceneSnapshot<'w> {
    /// The fixed world.
    pub world: &'w World,
    /// Moving bodies at their present poses.
    pub movers: &'w [Mover<'w>],
    /// Lights of the scene.
    pub lights: &'w Lights,
}

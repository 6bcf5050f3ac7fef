//! A world with its moving solids at one moment, as camera and laser see it.

use super::{Lights, Mover, World};

/// All that a camera or a laser may see at one moment.
#[derive(Debug, Clone, Copy)]
pub struct SceneSnapshot<'w> {
    /// The fixed world.
    pub world: &'w World,
    /// Moving bodies at their present poses.
    pub movers: &'w [Mover<'w>],
    /// How it is lit.
    pub lights: &'w Lights,
}

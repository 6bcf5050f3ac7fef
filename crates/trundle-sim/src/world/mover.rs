//! Moving solids, such as the parts of a walking person.

use super::World;
use trundle_core::Pose2;

/// A moving body: solids in their own frame, at a pose. A walking person consists of several.
#[derive(Debug, Clone, Copy)]
pub struct Mover<'w> {
    /// Solids with their appearance, in the body's frame, z up from the floor.
    pub body: &'w World,
    /// Pose of the body: `world_from_body`.
    pub pose: Pose2,
}

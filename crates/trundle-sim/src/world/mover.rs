//! Moving solids, such as the parts of a walking person.

use super::World;
use trundle_core::Pose2;

/// A moving body: solids in a frame of their own, at a pose. A walking person is a few of them.
#[derive(Debug, Clone, Copy)]
pub struct Mover<'w> {
    /// Its solids with their appearance, in its own frame, z up from the floor.
    pub body: &'w World,
    /// Where it stands: `world_from_body`.
    pub pose: Pose2,
}

//! Obstacles that the base can touch.

use crate::people::Crowd;
use crate::world::Obstacles;

/// Obstacles that the base can touch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactScene<'a> {
    /// Solids.
    pub(crate) fixed: &'a Obstacles,
    /// People.
    pub(crate) moving: &'a Crowd,
}

//! Axis-aligned bounding boxes.

use trundle_core::Vector3;

/// An axis-aligned box, world frame, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aabb {
    /// Lowest corner.
    pub(crate) min: Vector3,
    /// Highest corner.
    pub(crate) max: Vector3,
}

impl Aabb {
    pub(crate) fn union(self, other: Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    pub(crate) fn center(&self) -> Vector3 {
        (self.min + self.max) / 2.0
    }
}

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

    pub(crate) fn half(&self) -> Vector3 {
        (self.max - self.min) / 2.0
    }

    /// Whether the ray meets the box before `limit` (in units of the direction); `inverse` is 1 / direction.
    pub(crate) fn is_met(&self, origin: Vector3, inverse: Vector3, limit: f64) -> bool {
        let a = (self.min - origin).component_mul(&inverse);
        let b = (self.max - origin).component_mul(&inverse);
        let near = a.x.min(b.x).max(a.y.min(b.y)).max(a.z.min(b.z));
        let far = a.x.max(b.x).min(a.y.max(b.y)).min(a.z.max(b.z));
        near <= far && far >= 0.0 && near <= limit
    }
}

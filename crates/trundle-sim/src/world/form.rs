//! Solids with precomputed sine and cosine of their heading.

use super::Shape;

/// A solid for the camera, with precomputed sine and cosine.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Form {
    /// The middle of a box, or of a cylinder's lower disc, world frame, m.
    pub(crate) place: [f64; 3],
    /// Axes of the body in the world frame, unit length.
    pub(crate) axes: [[f64; 3]; 3],
    pub(crate) kind: Kind,
}

/// Sizes of a [`Form`], m.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    /// Half sides.
    Cuboid([f64; 3]),
    /// Radius and height.
    Cylinder(f64, f64),
}

impl Form {
    pub(super) fn new(shape: &Shape) -> Self {
        let (place, yaw, kind) = match shape {
            Shape::Cuboid(c) => (c.center, c.yaw, Kind::Cuboid((c.size / 2.0).into())),
            Shape::Cylinder(c) => (c.base, 0.0, Kind::Cylinder(c.radius, c.height)),
        };
        let (s, c) = yaw.sin_cos();
        Self { place: place.into(), axes: [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]], kind }
    }

    /// A point of the world in the solid's own frame.
    #[inline(always)]
    pub(crate) fn own(&self, point: [f64; 3]) -> [f64; 3] {
        let (x, y, z) = (point[0] - self.place[0], point[1] - self.place[1], point[2] - self.place[2]);
        let along = |axis: &[f64; 3]| axis[0] * x + axis[1] * y + axis[2] * z;
        [along(&self.axes[0]), along(&self.axes[1]), along(&self.axes[2])]
    }
}

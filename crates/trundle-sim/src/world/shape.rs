//! The solids of a world: boxes and upright cylinders.

use super::aabb::Aabb;
use super::outline::Outline;
use trundle_core::{Invalid, Vector2, Vector3};

/// A box, turned around z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cuboid {
    /// Middle of the box, world frame, m.
    pub center: Vector3,
    /// Full lengths along the box's own axes, m.
    pub size: Vector3,
    /// Turn around z, rad.
    pub yaw: f64,
}

/// An upright cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    /// Middle of the lower disc, world frame, m.
    pub base: Vector3,
    /// Metres.
    pub radius: f64,
    /// Metres.
    pub height: f64,
}

/// Geometry of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A box: walls, floors, furniture.
    Cuboid(Cuboid),
    /// An upright cylinder: table legs, bins.
    Cylinder(Cylinder),
}

impl Shape {
    /// Refuses numbers that are not finite and sizes that are not positive; `index` is for the message.
    pub(super) fn check(&self, index: usize) -> Result<(), Invalid> {
        let (numbers, sizes): (Vec<f64>, Vec<f64>) = match self {
            Self::Cuboid(c) => {
                (vec![c.center.x, c.center.y, c.center.z, c.yaw], c.size.iter().copied().collect())
            }
            Self::Cylinder(c) => (c.base.iter().copied().collect(), vec![c.radius, c.height]),
        };
        for number in numbers {
            trundle_core::require_finite(&format!("position of solid {index}"), number, "m")?;
        }
        for size in sizes {
            trundle_core::require_positive(&format!("size of solid {index}"), size, "m")?;
        }
        Ok(())
    }

    pub(super) fn aabb(&self) -> Aabb {
        let (center, half) = match self {
            Self::Cuboid(c) => {
                let (s, k) = c.yaw.sin_cos();
                let (s, k, h) = (s.abs(), k.abs(), c.size / 2.0);
                (c.center, Vector3::new(k * h.x + s * h.y, s * h.x + k * h.y, h.z))
            }
            Self::Cylinder(c) => {
                let half = Vector3::new(c.radius, c.radius, c.height / 2.0);
                (c.base + Vector3::new(0.0, 0.0, half.z), half)
            }
        };
        Aabb { min: center - half, max: center + half }
    }

    /// Outline in the top view.
    pub(super) fn outline(&self) -> Outline {
        match self {
            Self::Cuboid(c) => {
                let (s, k) = c.yaw.sin_cos();
                let corner = |sx: f64, sy: f64| {
                    let (x, y) = (sx * c.size.x / 2.0, sy * c.size.y / 2.0);
                    Vector2::new(c.center.x + k * x - s * y, c.center.y + s * x + k * y)
                };
                let corners =
                    vec![corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)];
                Outline::new(corners, 0.0)
            }
            Self::Cylinder(c) => Outline::new(vec![c.base.xy()], c.radius),
        }
    }
}

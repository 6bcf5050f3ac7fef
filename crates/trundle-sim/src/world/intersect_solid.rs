//! Intersection of a ray with a box or a cylinder.

use super::ray::turned;
use super::{Cuboid, Cylinder, Shape};
use trundle_core::{Vector2, Vector3};

impl Shape {
    /// Entry of a ray: distance in lengths of `direction`, and the outward normal.
    pub(super) fn intersect(&self, origin: Vector3, direction: Vector3) -> Option<(f64, Vector3)> {
        match self {
            Self::Cuboid(cuboid) => cuboid.intersect(origin, direction),
            Self::Cylinder(cylinder) => cylinder.intersect(origin, direction),
        }
    }
}

impl Cuboid {
    /// The slab method (Kay and Kajiya 1986) in the box's own frame.
    fn intersect(&self, origin: Vector3, direction: Vector3) -> Option<(f64, Vector3)> {
        let (s, c) = self.yaw.sin_cos();
        let (o, d) = (turned(origin - self.center, (-s, c)), turned(direction, (-s, c)));
        let (mut near, mut far, mut axis) = (f64::NEG_INFINITY, f64::INFINITY, 0);
        for k in 0..3 {
            let half = self.size[k] / 2.0;
            if d[k] == 0.0 {
                if o[k].abs() > half {
                    return None;
                }
                continue;
            }
            let entry = (-half * d[k].signum() - o[k]) / d[k];
            if entry > near {
                (near, axis) = (entry, k);
            }
            far = far.min((half * d[k].signum() - o[k]) / d[k]);
        }
        let mut normal = Vector3::zeros();
        normal[axis] = -d[axis].signum();
        (near <= far && near > 0.0).then(|| (near, turned(normal, (s, c))))
    }
}

impl Cylinder {
    fn intersect(&self, origin: Vector3, direction: Vector3) -> Option<(f64, Vector3)> {
        let o = origin - self.base;
        self.intersect_side(o, direction).or_else(|| self.intersect_lid(o, direction))
    }

    /// The ray's horizontal projection meets the circle if its distance to the axis, q / |d|, is below the radius.
    fn intersect_side(&self, o: Vector3, d: Vector3) -> Option<(f64, Vector3)> {
        let a = d.xy().norm_squared();
        let q = o.xy().perp(&d.xy());
        let root2 = a * self.radius * self.radius - q * q;
        if a == 0.0 || root2 < 0.0 {
            return None;
        }
        let t = (-o.xy().dot(&d.xy()) - root2.sqrt()) / a;
        let p = o + d * t;
        let inside = t > 0.0 && (0.0..=self.height).contains(&p.z);
        inside.then(|| (t, Vector3::new(p.x / self.radius, p.y / self.radius, 0.0)))
    }

    fn intersect_lid(&self, o: Vector3, d: Vector3) -> Option<(f64, Vector3)> {
        let lid = if d.z < 0.0 { self.height } else { 0.0 };
        let t = (lid - o.z) / d.z;
        let p: Vector2 = o.xy() + d.xy() * t;
        let inside = t > 0.0 && p.norm_squared() <= self.radius * self.radius;
        inside.then(|| (t, Vector3::new(0.0, 0.0, -d.z.signum())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{Finish, Paint};
    use crate::world::{Solid, World};

    fn world(shape: Shape) -> World {
        World::new(vec![Solid { shape, finish: Finish::all(Paint::Flat { color: [128; 3] }) }], 1).unwrap()
    }

    #[test]
    fn a_turned_box_is_met_at_its_corner() {
        let cuboid = Cuboid {
            center: Vector3::new(5.0, 0.0, 0.5),
            size: Vector3::new(2.0, 2.0, 1.0),
            yaw: std::f64::consts::FRAC_PI_4,
        };
        let world = world(Shape::Cuboid(cuboid));
        let hit = world.cast(Vector3::new(0.0, 1e-9, 0.5), Vector3::x(), 100.0).unwrap();
        assert!((hit.distance - (5.0 - 2.0_f64.sqrt())).abs() < 1e-8);
        let slanted = Vector3::new(-0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0);
        assert!((hit.normal - slanted).norm() < 1e-9, "{}", hit.normal);
        assert_eq!(world.cast(Vector3::new(0.0, 0.0, 1.1), Vector3::x(), 100.0), None);
        assert_eq!(world.cast(Vector3::new(5.0, 0.0, 0.5), Vector3::x(), 100.0), None, "from inside");
    }

    #[test]
    fn a_cylinder_is_met_at_its_side_and_its_lid() {
        let cylinder = Cylinder { base: Vector3::new(3.0, 0.0, 0.0), radius: 0.5, height: 1.0 };
        let world = world(Shape::Cylinder(cylinder));
        let side = world.cast(Vector3::new(0.0, 0.3, 0.5), Vector3::x(), 100.0).unwrap();
        assert!((side.distance - 2.6).abs() < 1e-12);
        assert!((side.normal - Vector3::new(-0.8, 0.6, 0.0)).norm() < 1e-12);
        let lid = world.cast(Vector3::new(3.2, 0.1, 5.0), -Vector3::z(), 100.0).unwrap();
        assert_eq!((lid.distance, lid.normal), (4.0, Vector3::z()));
        assert_eq!(world.cast(Vector3::new(0.0, 0.51, 0.5), Vector3::x(), 100.0), None);
    }
}

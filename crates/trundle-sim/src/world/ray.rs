//! Ray casting: the first surface that a ray meets.

use super::intersect_triangle::{intersect_block, normal_towards};
use super::probe::RayProbe;
use super::{Mover, SceneSnapshot, World};
use trundle_core::Vector3;

/// The first hit of a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance in lengths of the ray's direction: metres for a unit vector, depth for a component of 1 along the optical axis.
    pub distance: f64,
    /// The target.
    pub target: Target,
    /// Index of the snapshot's mover; `None` for a static object.
    pub mover: Option<usize>,
    /// Surface normal on the side of the ray's origin, unit length, frame of the world or snapshot.
    pub normal: Vector3,
}

/// A thing in a [`World`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// Index of a solid.
    Solid(usize),
    /// A triangle of a mesh.
    Triangle {
        /// Index of the mesh.
        mesh: usize,
        /// Index of the triangle in the mesh.
        triangle: usize,
    },
}

impl SceneSnapshot<'_> {
    /// The first thing along a ray from `origin` (world frame, m), nearer than `limit` lengths of `direction`; movers included.
    pub fn cast(&self, origin: Vector3, direction: Vector3, limit: f64) -> Option<Hit> {
        let mut nearest = self.world.cast(origin, direction, limit);
        for (i, mover) in self.movers.iter().enumerate() {
            let limit = nearest.map_or(limit, |hit| hit.distance);
            if let Some(hit) = mover.cast(origin, direction, limit) {
                nearest = Some(Hit { mover: Some(i), ..hit });
            }
        }
        nearest
    }
}

impl Mover<'_> {
    fn cast(&self, origin: Vector3, direction: Vector3, limit: f64) -> Option<Hit> {
        let (s, c) = self.pose.theta.sin_cos();
        let from_pose = Vector3::new(origin.x - self.pose.x, origin.y - self.pose.y, origin.z);
        let hit = self.body.cast(turned(from_pose, (-s, c)), turned(direction, (-s, c)), limit)?;
        Some(Hit { normal: turned(hit.normal, (s, c)), ..hit })
    }
}

impl World {
    /// The first thing along a ray from `origin` (world frame, m), nearer than `limit` lengths of `direction`.
    ///
    /// Solids that contain the origin are ignored; triangles have two sides, and no ray passes between two that share an edge. All numbers
    /// are f64: lasers use this function, and it is the reference of the renderer's tests.
    pub fn cast(&self, origin: Vector3, direction: Vector3, limit: f64) -> Option<Hit> {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the only feature that the function is compiled for.
            return unsafe { self.cast_by_avx2(origin, direction, limit) };
        }
        self.cast_plainly(origin, direction, limit)
    }

    /// The same as [`World::cast_plainly`], more numbers per instruction.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn cast_by_avx2(&self, origin: Vector3, direction: Vector3, limit: f64) -> Option<Hit> {
        self.cast_plainly(origin, direction, limit)
    }

    #[inline(always)]
    fn cast_plainly(&self, origin: Vector3, direction: Vector3, limit: f64) -> Option<Hit> {
        let probe = RayProbe::new(origin, direction);
        let solid = self.cast_at_solids(&probe, origin, direction, limit);
        let limit = solid.map_or(limit, |hit| hit.distance);
        self.cast_at_triangles(&probe, origin, direction, limit).or(solid)
    }

    #[inline(always)]
    fn cast_at_solids(
        &self,
        probe: &RayProbe,
        origin: Vector3,
        direction: Vector3,
        limit: f64,
    ) -> Option<Hit> {
        let (mut reach, mut nearest) = (limit, None);
        let mut walk = self.bvh.walk();
        while let Some(leaf) = walk.next(probe, wide(reach)) {
            let (first, end) = self.bvh.leaf(leaf);
            for &solid in &self.bvh.items()[first..end] {
                if let Some((distance, normal)) =
                    self.solids[solid as usize].shape.intersect(origin, direction)
                    && distance < reach
                {
                    reach = distance;
                    let target = Target::Solid(solid as usize);
                    nearest = Some(Hit { distance, target, mover: None, normal });
                }
            }
        }
        nearest
    }

    #[inline(always)]
    fn cast_at_triangles(
        &self,
        probe: &RayProbe,
        origin: Vector3,
        direction: Vector3,
        limit: f64,
    ) -> Option<Hit> {
        let (mut reach, mut nearest) = (limit, None);
        let mut walk = self.triangles.bvh().walk();
        while let Some(leaf) = walk.next(probe, wide(reach)) {
            let distances = intersect_block(self.triangles.block(leaf), origin, direction);
            for (lane, &distance) in distances.iter().enumerate() {
                if distance < reach {
                    reach = distance;
                    nearest = Some((leaf, lane));
                }
            }
        }
        let (leaf, lane) = nearest?;
        let block = self.triangles.block(leaf);
        let (mesh, triangle) = self.triangles.source(block.first as usize + lane);
        let normal = normal_towards(block, lane, direction);
        Some(Hit { distance: reach, target: Target::Triangle { mesh, triangle }, mover: None, normal })
    }
}

/// A value of at least `reach`.
fn wide(reach: f64) -> f32 {
    (reach as f32).next_up()
}

/// `v` turned around z by the angle with this sine and cosine.
pub(super) fn turned(v: Vector3, (s, c): (f64, f64)) -> Vector3 {
    Vector3::new(c * v.x - s * v.y, s * v.x + c * v.y, v.z)
}

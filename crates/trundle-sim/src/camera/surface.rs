//! Texture planes of the faces of boxes, cylinders and triangles.

use super::intersect_cylinder::LID_PART;
use super::lamps::Lamps;
use super::patch::{Patch, Plane};
use super::rays::{Rays, dot};
use super::world_view::{WorldView, single};
use crate::world::{Form, Kind};
use trundle_core::angle_of_f32;

impl<'w> WorldView<'w> {
    /// Colour of the surface `id` at `depth` m in the tile's pixel (row, column).
    #[inline(always)]
    pub(super) fn patch(
        &self,
        rays: &Rays,
        lamps: &Lamps,
        id: u32,
        (row, column, depth): (usize, usize, f32),
    ) -> Patch<'w> {
        let number = (id - self.first_id) as usize;
        let solids = self.world.solids().len();
        if number >= 4 * solids {
            return self.patch_of_triangle(rays, lamps, number - 4 * solids);
        }
        let form = &self.world.forms()[number / 4];
        let (face, plane) = match form.kind {
            Kind::Cuboid(half) => face_of_cuboid(form, self.apex, half, number % 4),
            Kind::Cylinder(radius, height) => {
                let ray = rays.at(row, column);
                face_of_cylinder(form.own(self.apex), (radius, height), number % 4, ray, depth)
            }
        };
        let light = lamps.on(self.in_scene(plane.normal));
        Patch::new(rays, &plane, &self.paintings[number / 4][face], light)
    }

    /// Whether the patch of this surface differs from pixel to pixel.
    #[inline(always)]
    pub(super) fn is_curved(&self, id: u32) -> bool {
        let number = (id - self.first_id) as usize;
        let form = self.world.forms().get(number / 4);
        number % 4 != LID_PART as usize && form.is_some_and(|form| matches!(form.kind, Kind::Cylinder(..)))
    }

    #[inline(always)]
    fn patch_of_triangle(&self, rays: &Rays, lamps: &Lamps, triangle: usize) -> Patch<'w> {
        let surface = self.world.triangles().surface(triangle);
        let ([x, y, z], corner) = (single(self.apex), surface.corner);
        let to_apex = [x - corner[0], y - corner[1], z - corner[2]];
        let start =
            [surface.uv[0] + dot(surface.across, to_apex), surface.uv[1] + dot(surface.down, to_apex)];
        let sign = if dot(surface.normal, to_apex) < 0.0 { -1.0 } else { 1.0 };
        let light = lamps.on(self.in_scene([
            sign * surface.normal[0],
            sign * surface.normal[1],
            sign * surface.normal[2],
        ]));
        let plane = Plane { normal: surface.normal, across: surface.across, down: surface.down, start };
        Patch::new(rays, &plane, &self.pictures[surface.material as usize], light)
    }

    /// A direction of this world in the frame of the scene.
    #[inline(always)]
    fn in_scene(&self, v: [f32; 3]) -> [f32; 3] {
        let (s, c) = self.heading;
        [c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]]
    }
}

/// The visible face of a box along an axis, and the orientation of its texture. From outside with z up, u is to the right and v down; on
/// the lids u is x, and v is opposite to y on the top.
#[inline(always)]
fn face_of_cuboid(form: &Form, apex: [f64; 3], half: [f64; 3], axis: usize) -> (usize, Plane) {
    let (own, half) = (single(form.own(apex)), single(half));
    let sign = own[axis].signum();
    let (u, v) = match axis {
        0 => ((1, sign), (2, -1.0)),
        1 => ((0, -sign), (2, -1.0)),
        _ => ((0, 1.0), (1, -sign)),
    };
    let along = |(k, sign): (usize, f32)| {
        let axis = single(form.axes[k]);
        [sign * axis[0], sign * axis[1], sign * axis[2]]
    };
    let start = [half[u.0] + u.1 * own[u.0], half[v.0] + v.1 * own[v.0]];
    let plane = Plane { normal: along((axis, sign)), across: along(u), down: along(v), start };
    (2 * axis + usize::from(sign < 0.0), plane)
}

#[inline(always)]
fn face_of_cylinder(
    own: [f64; 3],
    (radius, height): (f64, f64),
    part: usize,
    ray: [f32; 3],
    depth: f32,
) -> (usize, Plane) {
    let own = single(own);
    let (radius, height) = (radius as f32, height as f32);
    if part == LID_PART as usize {
        let sign = if own[2] > height / 2.0 { 1.0 } else { -1.0 };
        let plane = Plane {
            normal: [0.0, 0.0, sign],
            across: [1.0, 0.0, 0.0],
            down: [0.0, -sign, 0.0],
            start: [radius + own[0], radius - sign * own[1]],
        };
        return (if sign > 0.0 { 1 } else { 2 }, plane);
    }
    let (x, y, z) = (own[0] + depth * ray[0], own[1] + depth * ray[1], own[2] + depth * ray[2]);
    let (x, y) = (x / radius, y / radius);
    let uv = [(angle_of_f32(x, y) + std::f32::consts::PI) * radius, height - z];
    (0, Plane::through(uv, ray, depth, [x, y, 0.0], [-y, x, 0.0], [0.0, 0.0, -1.0]))
}

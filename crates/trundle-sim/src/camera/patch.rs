//! A plane textured surface under the pixels of a tile.

use super::rays::{Linear, Rays, dot};
use crate::materials::Texture;

/// A flat piece of surface under the pixels of a tile.
pub(super) struct Patch<'w> {
    /// `normal . ray`.
    pub(super) facing: Linear,
    /// Growth of the texture coordinates with depth along the ray, texels per metre.
    pub(super) across: Linear,
    pub(super) down: Linear,
    /// The texture coordinates that the camera's centre would have, texels.
    pub(super) start: [f32; 2],
    pub(super) texture: &'w Texture,
    /// Light in units of 1/256.
    pub(super) light: u32,
}

/// A painted plane in the frame of the rays.
pub(super) struct Plane {
    /// Unit length.
    pub(super) normal: [f32; 3],
    /// Growth of (u, v) per metre.
    pub(super) across: [f32; 3],
    pub(super) down: [f32; 3],
    /// (u, v) of the camera's centre: texture coordinates of its foot point.
    pub(super) start: [f32; 2],
}

impl<'w> Patch<'w> {
    #[inline(always)]
    pub(super) fn new(rays: &Rays, plane: &Plane, texture: &'w Texture, light: u32) -> Self {
        let [x, y] = texture.scale();
        Self {
            facing: rays.along(plane.normal),
            across: rays.along(plane.across).times(x),
            down: rays.along(plane.down).times(y),
            start: [plane.start[0] * x, plane.start[1] * y],
            texture,
            light,
        }
    }
}

impl Plane {
    /// The plane on which the point `uv` is seen at `depth` along `ray`.
    #[inline(always)]
    pub(super) fn through(
        uv: [f32; 2],
        ray: [f32; 3],
        depth: f32,
        normal: [f32; 3],
        across: [f32; 3],
        down: [f32; 3],
    ) -> Self {
        let start = [uv[0] - depth * dot(across, ray), uv[1] - depth * dot(down, ray)];
        Self { normal, across, down, start }
    }
}

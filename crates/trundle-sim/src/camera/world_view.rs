//! Visibility of a world from one camera pose: nearest surfaces for a tile of pixels.

use super::intersect_cuboid::intersect_cuboid;
use super::intersect_cylinder::intersect_cylinder;
use super::intersect_triangle::intersect_block;
use super::pyramid::Pyramid;
use super::rays::Rays;
use super::tile::{ROWS, TILE_COLUMNS, Tile};
use crate::materials::{Paintings, Texture};
use crate::world::{Kind, World};
use trundle_core::{PinholeCamera, Pose2, Pose3, Vector3};

/// A world in one image of the camera: all geometry in the frame of that world.
///
/// Surfaces are numbered from `first_id` on: four per solid (the axis of a box's face, or a part of a cylinder), then one per triangle.
pub(super) struct WorldView<'w> {
    pub(super) world: &'w World,
    pub(super) paintings: &'w Paintings,
    pub(super) pictures: &'w [Texture],
    /// The camera's centre, m.
    pub(super) apex: [f64; 3],
    /// Axes of the camera: right, down, forward.
    axes: [[f64; 3]; 3],
    /// Heading of the world in the scene: (sine, cosine).
    pub(super) heading: (f32, f32),
    pub(super) first_id: u32,
    /// Largest absolute coordinate, m.
    extent: f32,
    /// Bounds of the world's image: columns, then rows, px.
    window: [[f64; 2]; 2],
}

impl<'w> WorldView<'w> {
    /// The view of a world at `pose` in the scene.
    pub(super) fn new(
        world: &'w World,
        pose: Pose2,
        camera: &PinholeCamera,
        world_from_camera: &Pose3,
        first_id: u32,
    ) -> Self {
        let own_from_camera = Pose3::from_pose2(pose).inverse() * *world_from_camera;
        let (low, high) = world.bounds();
        let (s, c) = pose.theta.sin_cos();
        Self {
            world,
            paintings: world.paintings(),
            pictures: world.pictures(),
            apex: own_from_camera.translation.into(),
            axes: [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| own_from_camera.rotate(axis).into()),
            heading: (s as f32, c as f32),
            first_id,
            extent: low.amax().max(high.amax()) as f32,
            window: window(&own_from_camera.inverse(), camera, low, high),
        }
    }

    /// The last surface id plus one.
    pub(super) fn end_id(&self) -> u32 {
        self.first_id + 4 * self.world.solids().len() as u32 + self.world.triangles().len() as u32
    }

    /// The rays of the tile whose upper left pixel is (left, top).
    #[inline(always)]
    pub(super) fn rays(&self, camera: &PinholeCamera, left: usize, top: usize) -> Rays {
        let (x, y) = ((left as f64 - camera.cx()) / camera.fx(), (top as f64 - camera.cy()) / camera.fy());
        let [right, down, forward] = self.axes;
        let start = |k: usize| (x * right[k] + y * down[k] + forward[k]) as f32;
        let (per_column, per_row) = (1.0 / camera.fx(), 1.0 / camera.fy());
        Rays {
            start: [start(0), start(1), start(2)],
            right: single([right[0] * per_column, right[1] * per_column, right[2] * per_column]),
            down: single([down[0] * per_row, down[1] * per_row, down[2] * per_row]),
        }
    }

    /// Draws the nearest surfaces into the tile.
    #[inline(always)]
    pub(super) fn draw(&self, camera: &PinholeCamera, (left, top): (usize, usize), tile: &mut Tile) {
        if !self.may_be_in(left, top) {
            return;
        }
        let rays = self.rays(camera, left, top);
        let pyramid = Pyramid::new(&rays, single(self.apex), single(self.axes[2]), self.extent);
        self.draw_solids(&rays, &pyramid, tile);
        self.draw_triangles(&rays, &pyramid, tile);
    }

    #[inline(always)]
    fn may_be_in(&self, left: usize, top: usize) -> bool {
        let [[x0, x1], [y0, y1]] = self.window;
        let (left, top) = (left as f64, top as f64);
        x0 <= left + TILE_COLUMNS as f64 && left <= x1 && y0 <= top + ROWS as f64 && top <= y1
    }

    #[inline(always)]
    fn draw_solids(&self, rays: &Rays, pyramid: &Pyramid, tile: &mut Tile) {
        let (bvh, mut reach) = (self.world.bvh(), tile.reach());
        let mut walk = bvh.walk();
        while let Some(leaf) = walk.next(pyramid, reach) {
            let solid = bvh.items()[bvh.leaf(leaf).0];
            let form = &self.world.forms()[solid as usize];
            let (origin, id) = (form.own(self.apex), self.first_id + 4 * solid);
            match form.kind {
                Kind::Cuboid(half) => intersect_cuboid(rays, form.axes, origin, half, id, tile),
                Kind::Cylinder(radius, height) => {
                    intersect_cylinder(rays, origin, (radius, height), id, tile)
                }
            }
            reach = tile.reach();
        }
    }

    #[inline(always)]
    fn draw_triangles(&self, rays: &Rays, pyramid: &Pyramid, tile: &mut Tile) {
        let triangles = self.world.triangles();
        let first_id = self.first_id + 4 * self.world.solids().len() as u32;
        let mut reach = tile.reach();
        let mut walk = triangles.bvh().walk();
        while let Some(leaf) = walk.next(pyramid, reach) {
            let block = triangles.block(leaf);
            if intersect_block(rays, self.apex, block, first_id + block.first, 1.0 / reach, tile) {
                reach = tile.reach();
            }
        }
    }
}

/// The columns and rows between which a box appears: all when it reaches behind the camera.
fn window(camera_from_own: &Pose3, camera: &PinholeCamera, low: Vector3, high: Vector3) -> [[f64; 2]; 2] {
    let mut window = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for i in 0..8 {
        let pick = |k: usize| if i >> k & 1 == 0 { low[k] } else { high[k] };
        let corner = camera_from_own.transform(Vector3::new(pick(0), pick(1), pick(2)));
        if corner.z < 1e-3 {
            return [[f64::NEG_INFINITY, f64::INFINITY]; 2];
        }
        let pixel = [
            corner.x / corner.z * camera.fx() + camera.cx(),
            corner.y / corner.z * camera.fy() + camera.cy(),
        ];
        for (range, x) in window.iter_mut().zip(pixel) {
            *range = [range[0].min(x - 1.0), range[1].max(x + 1.0)];
        }
    }
    window
}

#[inline(always)]
pub(super) fn single(v: [f64; 3]) -> [f32; 3] {
    [v[0] as f32, v[1] as f32, v[2] as f32]
}

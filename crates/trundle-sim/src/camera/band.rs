//! Drawing of a band of image rows: visible surfaces, textures, light and depth.

use super::footprint::Footprints;
use super::lamps::Lamps;
use super::patch::Patch;
use super::rays::Rays;
use super::tile::{NO_SURFACE_ID, Row, TILE_COLUMNS, Tile};
use super::world_view::WorldView;
use trundle_core::PinholeCamera;

/// Lower bound of the cosines of incidence. Source: ours.
const MIN_COSINE: f32 = 1e-3;

/// All surfaces in one image.
pub(super) struct Picture<'a> {
    pub(super) camera: &'a PinholeCamera,
    /// The static world, then the moving ones.
    pub(super) views: &'a [WorldView<'a>],
    pub(super) lamps: &'a Lamps,
}

/// Up to [`ROWS`] rows of a view.
pub(super) struct Band<'a> {
    pub(super) depth: &'a mut [f32],
    pub(super) color: &'a mut [[u8; 3]],
    pub(super) cosine: &'a mut [f32],
}

impl Picture<'_> {
    /// Draws the band whose first row is `top`.
    pub(super) fn draw(&self, top: usize, band: &mut Band) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the only feature that the function is compiled for.
            return unsafe { self.draw_by_avx2(top, band) };
        }
        self.draw_plainly(top, band);
    }

    /// The same as [`Picture::draw_plainly`], more numbers per instruction.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn draw_by_avx2(&self, top: usize, band: &mut Band) {
        self.draw_plainly(top, band);
    }

    #[inline(always)]
    pub(super) fn draw_plainly(&self, top: usize, band: &mut Band) {
        let width = self.camera.width();
        let rows = band.depth.len() / width;
        for left in (0..width).step_by(TILE_COLUMNS) {
            let columns = TILE_COLUMNS.min(width - left);
            let mut tile = Tile::empty(columns, rows);
            for view in self.views.iter().rev() {
                view.draw(self.camera, (left, top), &mut tile);
            }
            let rays = self.views[0].rays(self.camera, left, top);
            for row in 0..rows {
                let at = row * width + left;
                let mut line = Band {
                    depth: &mut band.depth[at..at + columns],
                    color: &mut band.color[at..at + columns],
                    cosine: &mut band.cosine[at..at + columns],
                };
                self.shade(&tile, &rays, (left, top), row, &mut line);
            }
        }
    }

    /// Computes the colours of a tile's row; `still` are the rays in the static world.
    #[inline(always)]
    fn shade(&self, tile: &Tile, still: &Rays, (left, top): (usize, usize), row: usize, line: &mut Band) {
        let (inverse_depth, ids) = (&tile.inverse_depth[row], &tile.ids[row]);
        let length = self.lengths(left, top + row);
        let mut at = 0;
        while at < line.depth.len() {
            let id = ids[at];
            if id == NO_SURFACE_ID {
                (line.depth[at], line.color[at], line.cosine[at]) = (0.0, [0; 3], 0.0);
                at += 1;
                continue;
            }
            let view = self.view_of(id);
            let is_alone = view.is_curved(id);
            let end =
                (at + 1..line.depth.len()).find(|&i| is_alone || ids[i] != id).unwrap_or(line.depth.len());
            let rays = if view.first_id == 0 { *still } else { view.rays(self.camera, left, top) };
            let patch = view.patch(&rays, self.lamps, id, (row, at, 1.0 / inverse_depth[at]));
            let seen = Footprints::new(&patch, inverse_depth, row, &length);
            for (i, w) in inverse_depth.iter().enumerate().take(end).skip(at) {
                line.depth[i] = 1.0 / w;
                line.cosine[i] = seen.cosine[i].clamp(MIN_COSINE, 1.0);
                line.color[i] = color(&patch, &seen, i);
            }
            at = end;
        }
    }

    /// Lengths of the rays of 16 pixels of an image row whose part along the axis is 1.
    #[inline(always)]
    fn lengths(&self, left: usize, y: usize) -> Row<f32> {
        let camera = self.camera;
        let y = ((y as f64 - camera.cy()) / camera.fy()) as f32;
        let (x, step) = (((left as f64 - camera.cx()) / camera.fx()) as f32, (1.0 / camera.fx()) as f32);
        let mut lengths = [0.0; TILE_COLUMNS];
        for (i, length) in lengths.iter_mut().enumerate() {
            let x = x + i as f32 * step;
            *length = (x * x + y * y + 1.0).sqrt();
        }
        lengths
    }

    #[inline(always)]
    fn view_of(&self, id: u32) -> &WorldView<'_> {
        if id < self.views[0].end_id() {
            return &self.views[0];
        }
        let next = self.views.partition_point(|view| view.first_id <= id);
        &self.views[next - 1]
    }
}

/// The mean colour of a pixel's footprint.
#[inline(always)]
fn color(patch: &Patch, seen: &Footprints, i: usize) -> [u8; 3] {
    let (x, y, dx, dy, level) = (seen.x[i], seen.y[i], seen.shift_x[i], seen.shift_y[i], seen.level[i]);
    if dx == 0.0 && dy == 0.0 {
        return patch.texture.sample([x, y], level).dimmed(patch.light);
    }
    let near = patch.texture.sample([x - dx, y - dy], level);
    near.blend(patch.texture.sample([x + dx, y + dy], level), 128).dimmed(patch.light)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{Finish, Paint};
    use crate::world::{Cuboid, Cylinder, Lights, Material, Mesh, Shape, Solid, Triangle, World};
    use trundle_core::{ColorImage, Pose2, Pose3, Vector3};

    fn world() -> World {
        let cuboid =
            Cuboid { center: Vector3::new(3.0, 0.5, 0.0), size: Vector3::new(1.0, 1.5, 1.0), yaw: 0.4 };
        let cylinder = Cylinder { base: Vector3::new(2.5, -1.0, -1.0), radius: 0.4, height: 1.3 };
        let finish = Finish::all(Paint::Bricks);
        let solids = [Shape::Cuboid(cuboid), Shape::Cylinder(cylinder)]
            .map(|shape| Solid { shape, finish: finish.clone() });
        let positions =
            (0..60).map(|i| [4.0 + (i % 7) as f32, (i % 5) as f32 - 2.0, (i % 3) as f32 - 1.0]).collect();
        let uvs = (0..60).map(|i| [0.37 * i as f32, (i % 4) as f32]).collect();
        let triangles = (0..58).map(|i| Triangle { corners: [i, i + 1, i + 2], material: 0 }).collect();
        let picture = ColorImage::from_fn(37, 20, |x, y| [(x * 6) as u8, (y * 12) as u8, 77]);
        let materials =
            vec![Material { name: "picture".into(), color: [255, 200, 180], texture: Some(picture) }];
        World::with_meshes(solids.to_vec(), vec![Mesh::new(positions, uvs, triangles, materials).unwrap()], 1)
            .unwrap()
    }

    #[test]
    fn the_wide_way_and_the_plain_way_give_the_same_bits() {
        let camera = PinholeCamera::from_field_of_view((75, 8), (1.2, 0.3)).unwrap();
        let (world, lamps) = (world(), Lamps::new(&Lights::default()));
        // Looking along x: right is -y, down is -z.
        let turn = nalgebra::Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
        let pose = Pose3::from_matrix(turn, Vector3::new(0.1, 0.2, 0.3));
        let views = [WorldView::new(&world, Pose2::IDENTITY, &camera, &pose, 0)];
        let picture = Picture { camera: &camera, views: &views, lamps: &lamps };
        let drawn = |is_plain: bool| {
            let (mut depth, mut color, mut cosine) = (vec![0.0; 600], vec![[0; 3]; 600], vec![0.0; 600]);
            let mut band = Band { depth: &mut depth, color: &mut color, cosine: &mut cosine };
            if is_plain {
                picture.draw_plainly(0, &mut band)
            } else {
                picture.draw(0, &mut band)
            }
            let bits = |row: &[f32]| row.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            (bits(&depth), color, bits(&cosine))
        };
        let (wide, plain) = (drawn(false), drawn(true));
        assert!(wide == plain);
        assert!(wide.0.iter().filter(|&&depth| depth > 0).count() > 300);
    }
}

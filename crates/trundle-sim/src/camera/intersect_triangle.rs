//! Intersection of a tile's rays with triangles.

#![expect(clippy::needless_range_loop, reason = "loops over lanes by number become SIMD")]

use super::rays::{Linear, Rays};
use super::tile::{ROWS, TILE_COLUMNS, Tile, mask, smaller};
use crate::world::{Block, TRIANGLES_PER_BLOCK};

/// Records the triangles of a block where they are nearest. `apex` is the camera's centre in their frame, ids are `id` and the following
/// numbers. `floor` is the smallest inverse depth in the tile. Returns whether any pixel may have changed.
///
/// Triangle scan conversion in homogeneous coordinates (Olano and Greer 1997), with corners a, b, c relative to the camera. The ray d is on
/// the inner side of edge ab if d . (a x b) has the sign of the volume a . (b x c). The inverse depth is d . n / volume, where
/// n = a x b + b x c + c x a. All are affine functions of the pixel, without division or clipping. The two triangles at an edge have exactly opposite
/// functions of the edge: no pixel between them is lost.
#[inline(always)]
pub(super) fn intersect_block(
    rays: &Rays,
    apex: [f64; 3],
    block: &Block,
    id: u32,
    floor: f32,
    tile: &mut Tile,
) -> bool {
    let setups = Setups::new(rays, apex, block, floor);
    let mut is_changed = false;
    for lane in 0..TRIANGLES_PER_BLOCK {
        if setups.is_seen[lane] != 0 {
            is_changed = true;
            let [a, b, c, inverse_depth] = &setups.functions;
            intersect_triangle(
                a.of(lane),
                b.of(lane),
                c.of(lane),
                inverse_depth.of(lane),
                id + lane as u32,
                tile,
            );
        }
    }
    is_changed
}

#[inline(always)]
fn intersect_triangle(a: Linear, b: Linear, c: Linear, inverse_depth: Linear, id: u32, tile: &mut Tile) {
    let mut is_empty = [0; ROWS];
    for row in 0..ROWS {
        is_empty[row] =
            mask(a.max_in_row(row) < 0.0) | mask(b.max_in_row(row) < 0.0) | mask(c.max_in_row(row) < 0.0);
    }
    for row in 0..ROWS {
        if is_empty[row] != 0 {
            continue;
        }
        let (a, b, c, w) = (a.row(row), b.row(row), c.row(row), inverse_depth.row(row));
        let mut is_hit = [0; TILE_COLUMNS];
        for i in 0..TILE_COLUMNS {
            is_hit[i] = mask(smaller(smaller(a[i], b[i]), c[i]) >= 0.0);
        }
        tile.keep(row, &w, &is_hit, &[id; TILE_COLUMNS]);
    }
}

/// [`Linear`] functions, one a triangle.
#[derive(Clone, Copy)]
struct Functions {
    start: [f32; TRIANGLES_PER_BLOCK],
    right: [f32; TRIANGLES_PER_BLOCK],
    down: [f32; TRIANGLES_PER_BLOCK],
}

impl Functions {
    const ZERO: Self = Self {
        start: [0.0; TRIANGLES_PER_BLOCK],
        right: [0.0; TRIANGLES_PER_BLOCK],
        down: [0.0; TRIANGLES_PER_BLOCK],
    };

    #[inline(always)]
    fn of(&self, lane: usize) -> Linear {
        Linear { start: self.start[lane], right: self.right[lane], down: self.down[lane] }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, function: Linear) {
        self.start[lane] = function.start;
        self.right[lane] = function.right;
        self.down[lane] = function.down;
    }
}

/// For each triangle the functions of its three edges, positive inside, and the inverse depth.
struct Setups {
    functions: [Functions; 4],
    /// All bits set if the triangle may be visible in the tile.
    is_seen: [u32; TRIANGLES_PER_BLOCK],
}

impl Setups {
    #[inline(always)]
    fn new(rays: &Rays, o: [f64; 3], block: &Block, floor: f32) -> Self {
        let [mut edge_bc, mut edge_ca, mut edge_ab, mut inverse_depth] = [Functions::ZERO; 4];
        let mut is_seen = [0; TRIANGLES_PER_BLOCK];
        let [a, b, c] = &block.corners;
        for i in 0..TRIANGLES_PER_BLOCK {
            let a = [f64::from(a[0][i]) - o[0], f64::from(a[1][i]) - o[1], f64::from(a[2][i]) - o[2]];
            let b = [f64::from(b[0][i]) - o[0], f64::from(b[1][i]) - o[1], f64::from(b[2][i]) - o[2]];
            let c = [f64::from(c[0][i]) - o[0], f64::from(c[1][i]) - o[1], f64::from(c[2][i]) - o[2]];
            let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
            let volume = a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2];
            let sign = if volume < 0.0 { -1.0 } else { 1.0 };
            let inverse = 1.0 / volume;
            let bc_along = rays.along([(sign * bc[0]) as f32, (sign * bc[1]) as f32, (sign * bc[2]) as f32]);
            let ca_along = rays.along([(sign * ca[0]) as f32, (sign * ca[1]) as f32, (sign * ca[2]) as f32]);
            let ab_along = rays.along([(sign * ab[0]) as f32, (sign * ab[1]) as f32, (sign * ab[2]) as f32]);
            let plane = rays.along([
                ((bc[0] + ca[0] + ab[0]) * inverse) as f32,
                ((bc[1] + ca[1] + ab[1]) * inverse) as f32,
                ((bc[2] + ca[2] + ab[2]) * inverse) as f32,
            ]);
            is_seen[i] = mask(bc_along.max() >= 0.0)
                & mask(ca_along.max() >= 0.0)
                & mask(ab_along.max() >= 0.0)
                & mask(plane.max() > floor)
                & mask(volume != 0.0);
            edge_bc.set(i, bc_along);
            edge_ca.set(i, ca_along);
            edge_ab.set(i, ab_along);
            inverse_depth.set(i, plane);
        }
        Self { functions: [edge_bc, edge_ca, edge_ab, inverse_depth], is_seen }
    }
}

#[inline(always)]
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

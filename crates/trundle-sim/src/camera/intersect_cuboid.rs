//! Intersection of a tile's rays with a box.

use super::rays::{Linear, Rays};
use super::tile::{ROWS, TILE_COLUMNS, Tile, larger, mask, smaller};

/// Records the faces of a box where they are nearest. `origin` is the camera's centre in the box's frame; `rays` are in the frame in which
/// `axes` are the box's. The last two bits of the id become the axis of the face.
///
/// Slabs (Kay and Kajiya 1986) in inverse depth: on the plane of each face it is an affine function of the pixel. A ray enters the box
/// through the last of the planes that face the camera, the smallest inverse depth, if that is before the first of the others.
#[inline(always)]
pub(super) fn intersect_cuboid(
    rays: &Rays,
    axes: [[f64; 3]; 3],
    origin: [f64; 3],
    half: [f64; 3],
    id: u32,
    tile: &mut Tile,
) {
    let mut near = [Linear::constant(f32::INFINITY); 3];
    let mut far = [Linear::constant(f32::NEG_INFINITY); 6];
    for k in 0..3 {
        let axis = [axes[k][0] as f32, axes[k][1] as f32, axes[k][2] as f32];
        let along = rays.along(axis);
        let (high, low) =
            (along.times(inverse(half[k] - origin[k])), along.times(inverse(-half[k] - origin[k])));
        (far[k], far[k + 3]) = (high, low);
        if origin[k] > half[k] {
            (near[k], far[k]) = (high, low);
        } else if origin[k] < -half[k] {
            (near[k], far[k + 3]) = (low, high);
        }
    }
    let [x, y, z] = near;
    let [f0, f1, f2, f3, f4, f5] = far;
    for row in 0..ROWS {
        let (x, y, z) = (x.row(row), y.row(row), z.row(row));
        let (f0, f1, f2) = (f0.row(row), f1.row(row), f2.row(row));
        let (f3, f4, f5) = (f3.row(row), f4.row(row), f5.row(row));
        let (mut entries, mut is_hit, mut ids) = ([0.0; TILE_COLUMNS], [0; TILE_COLUMNS], [0; TILE_COLUMNS]);
        for i in 0..TILE_COLUMNS {
            let entry = smaller(smaller(x[i], y[i]), z[i]);
            let exit = larger(larger(larger(f0[i], f1[i]), larger(f2[i], f3[i])), larger(f4[i], f5[i]));
            // For equal values, the first axis is used. From inside the box, the entry is infinite.
            ids[i] = id + (mask(x[i] > entry) & (1 + (mask(y[i] > entry) & 1)));
            is_hit[i] = mask(entry >= exit) & mask(entry < f32::INFINITY);
            entries[i] = entry;
        }
        tile.keep(row, &entries, &is_hit, &ids);
    }
}

/// 1 / x, finite.
#[inline(always)]
fn inverse(x: f64) -> f32 {
    (1.0 / x.abs().max(1e-9).copysign(x)) as f32
}

//! Intersection of a tile's rays with an upright cylinder.

use super::rays::{Linear, Rays};
use super::tile::{ROWS, TILE_COLUMNS, Tile, larger, mask};

/// Parts of a cylinder in the last two bits of an id. Source: ours.
pub(super) const SIDE_PART: u32 = 0;
pub(super) const LID_PART: u32 = 1;

/// Records the side and the lids of an upright cylinder where they are nearest; `o` is the camera's centre relative to the middle of the
/// lower disc.
///
/// With w = 1 / depth the ray is at (o w + d) / w. At the side, the horizontal part has the length of the radius. The discriminant uses the
/// horizontal distance of the ray to the axis, a cross product, which avoids cancellation.
#[inline(always)]
pub(super) fn intersect_cylinder(
    rays: &Rays,
    o: [f64; 3],
    (radius, height): (f64, f64),
    id: u32,
    tile: &mut Tile,
) {
    let outside = o[0] * o[0] + o[1] * o[1] - radius * radius;
    let inverse = if outside > 0.0 { (1.0 / outside.max(1e-12)) as f32 } else { 0.0 };
    let (x, y, z) = (o[0] as f32, o[1] as f32, o[2] as f32);
    let (radius, height) = (radius as f32, height as f32);
    // From a height between the lids neither lid is visible.
    let lid_factor = match z {
        z if z > height => 1.0 / (height - z),
        z if z < 0.0 => 1.0 / -z,
        _ => 0.0,
    };
    let axes = [rays.along([1.0, 0.0, 0.0]), rays.along([0.0, 1.0, 0.0]), rays.along([0.0, 0.0, 1.0])];
    let across = Linear {
        start: x * axes[1].start - y * axes[0].start,
        right: x * axes[1].right - y * axes[0].right,
        down: x * axes[1].down - y * axes[0].down,
    };
    for row in 0..ROWS {
        let (dx, dy, dz, across) = (axes[0].row(row), axes[1].row(row), axes[2].row(row), across.row(row));
        let (mut sides, mut is_side) = ([0.0; TILE_COLUMNS], [0; TILE_COLUMNS]);
        let (mut lids, mut is_lid) = ([0.0; TILE_COLUMNS], [0; TILE_COLUMNS]);
        for i in 0..TILE_COLUMNS {
            let root2 = (dx[i] * dx[i] + dy[i] * dy[i]) * radius * radius - across[i] * across[i];
            let side = (larger(root2, 0.0).sqrt() - (x * dx[i] + y * dy[i])) * inverse;
            let rise = z * side + dz[i];
            is_side[i] = mask(root2 >= 0.0) & mask(rise >= 0.0) & mask(rise <= height * side);
            sides[i] = side;
            let lid = dz[i] * lid_factor;
            let (u, v) = (x * lid + dx[i], y * lid + dy[i]);
            is_lid[i] = mask(u * u + v * v <= radius * radius * lid * lid);
            lids[i] = lid;
        }
        tile.keep(row, &sides, &is_side, &[id + SIDE_PART; TILE_COLUMNS]);
        tile.keep(row, &lids, &is_lid, &[id + LID_PART; TILE_COLUMNS]);
    }
}

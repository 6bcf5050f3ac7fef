//! Intersection of a ray with a block of triangles.

use super::triangles::{Block, TRIANGLES_PER_BLOCK};
use trundle_core::Vector3;

/// Distance along a ray to each triangle of a block, in lengths of its direction; infinite for a miss.
///
/// The ray hits a triangle if it is on the same side of all three edges, by the sign of direction . (a x b). This sign is exactly opposite
/// for the other triangle at the edge, so no ray passes between two triangles.
#[inline(always)]
pub(super) fn intersect_block(
    block: &Block,
    origin: Vector3,
    direction: Vector3,
) -> [f64; TRIANGLES_PER_BLOCK] {
    let mut distances = [0.0; TRIANGLES_PER_BLOCK];
    let ([a, b, c], o, d) = (&block.corners, origin, direction);
    for i in 0..TRIANGLES_PER_BLOCK {
        let (ax, ay, az) = (f64::from(a[0][i]) - o.x, f64::from(a[1][i]) - o.y, f64::from(a[2][i]) - o.z);
        let (bx, by, bz) = (f64::from(b[0][i]) - o.x, f64::from(b[1][i]) - o.y, f64::from(b[2][i]) - o.z);
        let (cx, cy, cz) = (f64::from(c[0][i]) - o.x, f64::from(c[1][i]) - o.y, f64::from(c[2][i]) - o.z);
        let (bc_x, bc_y, bc_z) = (by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx);
        let (ca_x, ca_y, ca_z) = (cy * az - cz * ay, cz * ax - cx * az, cx * ay - cy * ax);
        let (ab_x, ab_y, ab_z) = (ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx);
        let u = bc_x * d.x + bc_y * d.y + bc_z * d.z;
        let v = ca_x * d.x + ca_y * d.y + ca_z * d.z;
        let w = ab_x * d.x + ab_y * d.y + ab_z * d.z;
        let volume = ax * bc_x + ay * bc_y + az * bc_z;
        let t = volume / (u + v + w);
        let is_inside = ((u >= 0.0) & (v >= 0.0) & (w >= 0.0)) | ((u <= 0.0) & (v <= 0.0) & (w <= 0.0));
        // A triangle seen edge on, and one that is a point, give 0 / 0.
        distances[i] = if is_inside & (t > 0.0) { t } else { f64::INFINITY };
    }
    distances
}

/// The normal of a triangle of a block, on the side that a ray of this direction comes from.
pub(super) fn normal_towards(block: &Block, lane: usize, direction: Vector3) -> Vector3 {
    let corner = |i: usize| Vector3::from([0, 1, 2].map(|k| f64::from(block.corners[i][k][lane])));
    let normal = (corner(1) - corner(0)).cross(&(corner(2) - corner(0))).normalize();
    if normal.dot(&direction) > 0.0 { -normal } else { normal }
}

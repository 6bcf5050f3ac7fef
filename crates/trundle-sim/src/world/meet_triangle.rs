use super::triangles::{BLOCK, Block};
use trundle_core::Vector3;

/// How far a ray goes to each triangle of a block, in lengths of its direction; infinite for those it misses.
///
/// The ray passes inside where it is on the same side of all three edges: the sign of direction . (a x b), which is exactly
/// opposite for the other triangle at the same edge, so that no ray slips through between two triangles.
#[inline(always)]
pub(super) fn meet_block(block: &Block, origin: Vector3, direction: Vector3) -> [f64; BLOCK] {
    let mut distances = [0.0; BLOCK];
    for (lane, distance) in distances.iter_mut().enumerate() {
        let corner = |i: usize| [0, 1, 2].map(|k| f64::from(block.corners[i][k][lane]) - origin[k]);
        let (a, b, c) = (corner(0), corner(1), corner(2));
        let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
        let d = [direction.x, direction.y, direction.z];
        let (u, v, w) = (dot(bc, d), dot(ca, d), dot(ab, d));
        let volume = dot(a, bc);
        let t = volume / (u + v + w);
        let is_inside = ((u >= 0.0) & (v >= 0.0) & (w >= 0.0)) | ((u <= 0.0) & (v <= 0.0) & (w <= 0.0));
        // A triangle seen edge on, and one that is a point, give 0 / 0.
        *distance = if is_inside & (t > 0.0) { t } else { f64::INFINITY };
    }
    distances
}

/// The normal of a triangle of a block, on the side that a ray of this direction comes from.
pub(super) fn normal_towards(block: &Block, lane: usize, direction: Vector3) -> Vector3 {
    let corner = |i: usize| Vector3::from([0, 1, 2].map(|k| f64::from(block.corners[i][k][lane])));
    let normal = (corner(1) - corner(0)).cross(&(corner(2) - corner(0))).normalize();
    if normal.dot(&direction) > 0.0 { -normal } else { normal }
}

#[inline(always)]
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

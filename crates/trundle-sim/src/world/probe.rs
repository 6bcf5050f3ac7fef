//! Ray against bounding boxes, in f32 with a safe margin.

#![expect(clippy::needless_range_loop, reason = "loops over lanes by number become SIMD")]

use super::bvh::{Node, Probe, WIDTH};
use trundle_core::Vector3;

/// Relative slack of distances: more than the roundings of a subtraction and a product. Source: ours, four times the rounding of f32.
const RELATIVE_ROUNDING: f32 = 4.0 / (1 << 23) as f32;

/// A ray among boxes, in f32: slabs (Kay and Kajiya 1986), wider by more than any rounding.
pub(super) struct RayProbe {
    origin: [f32; 3],
    inverse: [f32; 3],
    /// Additional width, m.
    slack: f32,
}

impl RayProbe {
    pub(super) fn new(origin: Vector3, direction: Vector3) -> Self {
        let inverse = |d: f64| 1.0 / (d.abs().max(1e-30).copysign(d) as f32);
        Self {
            origin: [origin.x as f32, origin.y as f32, origin.z as f32],
            inverse: [inverse(direction.x), inverse(direction.y), inverse(direction.z)],
            slack: origin.amax() as f32 * RELATIVE_ROUNDING,
        }
    }
}

impl Probe for RayProbe {
    #[inline(always)]
    fn distances(&self, node: &Node) -> [f32; WIDTH] {
        let mut distances = [0.0; WIDTH];
        for i in 0..WIDTH {
            let (near_x, far_x) = self.slab(0, node.low[0][i], node.high[0][i]);
            let (near_y, far_y) = self.slab(1, node.low[1][i], node.high[1][i]);
            let (near_z, far_z) = self.slab(2, node.low[2][i], node.high[2][i]);
            let near = larger(larger(near_x, near_y), larger(near_z, 0.0)) * (1.0 - RELATIVE_ROUNDING);
            let far = smaller(smaller(far_x, far_y), far_z) * (1.0 + RELATIVE_ROUNDING);
            distances[i] = if near <= far { near } else { f32::INFINITY };
        }
        distances
    }
}

impl RayProbe {
    /// Entry and exit of the ray between two planes.
    #[inline(always)]
    fn slab(&self, axis: usize, low: f32, high: f32) -> (f32, f32) {
        let a = (low - self.origin[axis] - self.slack) * self.inverse[axis];
        let b = (high - self.origin[axis] + self.slack) * self.inverse[axis];
        (smaller(a, b), larger(a, b))
    }
}

/// `f32::min` without its care for NaN, which costs instructions.
#[inline(always)]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// `f32::max` without its care for NaN, which costs instructions.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

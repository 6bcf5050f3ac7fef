use super::bvh::{Node, Probe, WIDTH};
use trundle_core::Vector3;

/// Relative slack of distances: more than the roundings of a subtraction and a product.
const ROUNDING: f32 = 4.0 / (1 << 23) as f32;

/// A ray among boxes, in f32: slabs (Kay and Kajiya 1986), wider by more than any rounding.
pub(super) struct RayProbe {
    /// Whether the ray rises along each axis.
    rises: [bool; 3],
    /// The origin, moved towards and away from where the ray goes.
    origin_near: [f32; 3],
    origin_far: [f32; 3],
    inverse: [f32; 3],
}

impl RayProbe {
    pub(super) fn new(origin: Vector3, direction: Vector3) -> Self {
        let slack = (origin.amax() as f32) * ROUNDING;
        let d: [f32; 3] = direction.map(|x| x as f32).into();
        let o: [f32; 3] = origin.map(|x| x as f32).into();
        let inverse = d.map(|d| 1.0 / d.abs().max(1e-30).copysign(d));
        let ahead = |sign: f32| [0, 1, 2].map(|k| o[k] + sign * slack.copysign(inverse[k]));
        Self { rises: inverse.map(|x| x > 0.0), origin_near: ahead(1.0), origin_far: ahead(-1.0), inverse }
    }
}

impl Probe for RayProbe {
    #[inline(always)]
    fn distances(&self, node: &Node) -> [f32; WIDTH] {
        let mut near = [0.0_f32; WIDTH];
        let mut far = [f32::INFINITY; WIDTH];
        for k in 0..3 {
            let (entry, exit) =
                if self.rises[k] { (&node.low[k], &node.high[k]) } else { (&node.high[k], &node.low[k]) };
            for i in 0..WIDTH {
                let a = (entry[i] - self.origin_near[k]) * self.inverse[k];
                let b = (exit[i] - self.origin_far[k]) * self.inverse[k];
                near[i] = if a > near[i] { a } else { near[i] };
                far[i] = if b < far[i] { b } else { far[i] };
            }
        }
        let mut distances = [0.0; WIDTH];
        for i in 0..WIDTH {
            let (near, far) = (near[i] * (1.0 - ROUNDING), far[i] * (1.0 + ROUNDING));
            distances[i] = if near <= far { near } else { f32::INFINITY };
        }
        distances
    }
}

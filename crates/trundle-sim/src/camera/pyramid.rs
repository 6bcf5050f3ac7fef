use super::rays::{Rays, cross};
use super::tile::{COLUMNS, ROWS};
use crate::world::{Node, Probe, WIDTH};

/// How far a pyramid reaches beyond the centres of its outer pixels, px: more than any rounding.
const MARGIN: f32 = 0.02;

/// Relative slack of places against the camera's.
const ROUNDING: f32 = 8.0 / (1 << 23) as f32;

/// A pyramid from the camera through the pixels of a tile, in the frame of a world.
pub(super) struct Pyramid {
    apex: [f32; 3],
    axis: [f32; 3],
    /// Inward normals of its sides and how far outside a box may be.
    sides: [([f32; 3], f32); 4],
    slack: f32,
}

impl Pyramid {
    /// `axis` is the optical axis; `extent` bounds the coordinates of the world.
    #[inline(always)]
    pub(super) fn new(rays: &Rays, apex: [f32; 3], axis: [f32; 3], extent: f32) -> Self {
        let corner = |column: f32, row: f32| {
            [0, 1, 2].map(|k| rays.start[k] + column * rays.right[k] + row * rays.down[k])
        };
        let (x1, y1) = ((COLUMNS - 1) as f32 + MARGIN, (ROWS - 1) as f32 + MARGIN);
        // Clockwise in the image: each side's normal, edge x next edge, points inward.
        let edges = [corner(-MARGIN, -MARGIN), corner(x1, -MARGIN), corner(x1, y1), corner(-MARGIN, y1)];
        let slack = ROUNDING * (extent + apex.iter().fold(0.0, |most, x| x.abs().max(most)));
        let sides = [0, 1, 2, 3].map(|i| {
            let normal = cross(edges[i], edges[(i + 1) % 4]);
            (normal, slack * (normal[0].abs() + normal[1].abs() + normal[2].abs()))
        });
        Self { apex, axis, sides, slack }
    }
}

impl Probe for Pyramid {
    /// Depths along the optical axis.
    #[inline(always)]
    fn distances(&self, node: &Node) -> [f32; WIDTH] {
        let from_apex = |bounds: &[[f32; WIDTH]; 3]| {
            let mut from_apex = [[0.0; WIDTH]; 3];
            for k in 0..3 {
                for i in 0..WIDTH {
                    from_apex[k][i] = bounds[k][i] - self.apex[k];
                }
            }
            from_apex
        };
        let (low, high) = (from_apex(&node.low), from_apex(&node.high));
        // Most of a plane's function over each box.
        let most = |normal: [f32; 3]| {
            let corner = [0, 1, 2].map(|k| if normal[k] > 0.0 { &high[k] } else { &low[k] });
            let mut most = [0.0; WIDTH];
            for i in 0..WIDTH {
                most[i] = normal[0] * corner[0][i] + normal[1] * corner[1][i] + normal[2] * corner[2][i];
            }
            most
        };
        let nearest = most(self.axis.map(|x| -x));
        let farthest = most(self.axis);
        let mut distances = [0.0; WIDTH];
        for i in 0..WIDTH {
            let depth = -nearest[i] - self.slack;
            let depth = if depth > 0.0 { depth } else { 0.0 };
            distances[i] = if farthest[i] + self.slack > 0.0 { depth } else { f32::INFINITY };
        }
        for (normal, slack) in &self.sides {
            let most = most(*normal);
            for i in 0..WIDTH {
                distances[i] = if most[i] + slack >= 0.0 { distances[i] } else { f32::INFINITY };
            }
        }
        distances
    }
}

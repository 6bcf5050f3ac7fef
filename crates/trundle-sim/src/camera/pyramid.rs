//! The view pyramid of a tile, tested against bounding boxes.

#![expect(clippy::needless_range_loop, reason = "loops over lanes by number become SIMD")]

use super::rays::{Rays, cross};
use super::tile::{ROWS, TILE_COLUMNS};
use crate::world::{Node, Probe, WIDTH};

/// Margin of a pyramid outside the centres of its outer pixels, px: larger than any rounding error. Source: ours.
const OUTER_MARGIN_PX: f32 = 0.02;

/// Relative slack of places against the camera's. Source: ours, eight times the rounding of f32.
const RELATIVE_ROUNDING: f32 = 8.0 / (1 << 23) as f32;

/// A pyramid from the camera through the pixels of a tile, in the frame of a world.
pub(super) struct Pyramid {
    apex: [f32; 3],
    axis: [f32; 3],
    /// Inward normals of the sides, and the allowed distance of a box outside.
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
        let (x1, y1) = ((TILE_COLUMNS - 1) as f32 + OUTER_MARGIN_PX, (ROWS - 1) as f32 + OUTER_MARGIN_PX);
        // Clockwise in the image: each side's normal, edge x next edge, points inward.
        let edges = [
            corner(-OUTER_MARGIN_PX, -OUTER_MARGIN_PX),
            corner(x1, -OUTER_MARGIN_PX),
            corner(x1, y1),
            corner(-OUTER_MARGIN_PX, y1),
        ];
        let slack = RELATIVE_ROUNDING * (extent + apex.iter().fold(0.0, |max, x| x.abs().max(max)));
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
        let (apex, axis, slack) = (self.apex, self.axis, self.slack);
        let [(left, left_slack), (right, right_slack), (top, top_slack), (bottom, bottom_slack)] = self.sides;
        let mut distances = [0.0; WIDTH];
        for i in 0..WIDTH {
            let low = [node.low[0][i] - apex[0], node.low[1][i] - apex[1], node.low[2][i] - apex[2]];
            let high = [node.high[0][i] - apex[0], node.high[1][i] - apex[1], node.high[2][i] - apex[2]];
            let depth = -max([-axis[0], -axis[1], -axis[2]], low, high) - slack;
            let is_hit = (max(axis, low, high) + slack > 0.0)
                & (max(left, low, high) + left_slack >= 0.0)
                & (max(right, low, high) + right_slack >= 0.0)
                & (max(top, low, high) + top_slack >= 0.0)
                & (max(bottom, low, high) + bottom_slack >= 0.0);
            let depth = if depth > 0.0 { depth } else { 0.0 };
            distances[i] = if is_hit { depth } else { f32::INFINITY };
        }
        distances
    }
}

/// The maximum of `normal . place` over a box.
#[inline(always)]
fn max(normal: [f32; 3], low: [f32; 3], high: [f32; 3]) -> f32 {
    let part = |k: usize| {
        let (a, b) = (normal[k] * low[k], normal[k] * high[k]);
        if a > b { a } else { b }
    };
    part(0) + part(1) + part(2)
}

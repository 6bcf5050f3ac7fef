//! The area of a texture that each pixel of a row covers.

use super::patch::Patch;
use super::tile::{Row, TILE_COLUMNS};

/// Ratio of length to width of a pixel's footprint above which two samples along its length are used. Source: ours.
const MAX_ANISOTROPY: f32 = 2.0;

/// Footprints of the pixels of a row on a patch.
pub(super) struct Footprints {
    /// The middle, texels.
    pub(super) x: Row<f32>,
    pub(super) y: Row<f32>,
    /// From the middle to each of the two samples, texels; zero if one sample is enough.
    pub(super) shift_x: Row<f32>,
    pub(super) shift_y: Row<f32>,
    /// log2 of the width of a sample, texels.
    pub(super) level: Row<f32>,
    /// Cosine between ray and normal.
    pub(super) cosine: Row<f32>,
}

impl Footprints {
    /// `steps` are the sizes of a pixel at 1 m, `length` the lengths of the rays.
    ///
    /// A pixel covers a parallelogram of the texture, spanned by the changes for one step right and one step down. Its long and short side
    /// are the singular values of that matrix (Heckbert 1989, "Fundamentals of texture mapping").
    #[inline(always)]
    pub(super) fn new(patch: &Patch, inverse_depth: &Row<f32>, row: usize, length: &Row<f32>) -> Self {
        let mut all = Self {
            x: [0.0; TILE_COLUMNS],
            y: [0.0; TILE_COLUMNS],
            shift_x: [0.0; TILE_COLUMNS],
            shift_y: [0.0; TILE_COLUMNS],
            level: [0.0; TILE_COLUMNS],
            cosine: [0.0; TILE_COLUMNS],
        };
        let (facing, across, down) = (patch.facing.row(row), patch.across.row(row), patch.down.row(row));
        for i in 0..TILE_COLUMNS {
            let depth = 1.0 / inverse_depth[i];
            all.x[i] = patch.start[0] + depth * across[i];
            all.y[i] = patch.start[1] + depth * down[i];
            all.cosine[i] = facing[i].abs() / length[i];
            // Along the plane, a step right changes the ray by right - ray (normal . right) / (normal . ray), times depth.
            let inverse = 1.0 / facing[i];
            let (right, below) = (patch.facing.right * inverse, patch.facing.down * inverse);
            let (ax, ay) = (patch.across.right - across[i] * right, patch.down.right - down[i] * right);
            let (bx, by) = (patch.across.down - across[i] * below, patch.down.down - down[i] * below);
            let (p, q, s) = (ax * ax + bx * bx, ax * ay + bx * by, ay * ay + by * by);
            let (mean, half) = (0.5 * (p + s), 0.5 * (p - s));
            let radius = (half * half + q * q).sqrt();
            let long = (mean + radius).sqrt() + 1e-20;
            let short = (ax * by - ay * bx).abs() / long;
            let is_slanted = long > MAX_ANISOTROPY * short;
            // The eigenvector of the greater eigenvalue, by the form that does not cancel.
            let (ex, ey) = if half >= 0.0 { (half + radius, q) } else { (q, radius - half) };
            let quarter = 0.25 * depth * long / ((ex * ex + ey * ey).sqrt() + 1e-30);
            all.shift_x[i] = if is_slanted { quarter * ex } else { 0.0 };
            all.shift_y[i] = if is_slanted { quarter * ey } else { 0.0 };
            let half_long = 0.5 * long;
            let narrow = if short > half_long { short } else { half_long };
            let width = if is_slanted { narrow } else { (long * short).sqrt() };
            all.level[i] = fast_log2(depth * width);
        }
        all
    }
}

/// log2 by the exponent and a straight line over the mantissa: at most 0.09 low. Smooth, which is what matters here.
#[inline(always)]
fn fast_log2(x: f32) -> f32 {
    x.to_bits() as i32 as f32 / (1 << 23) as f32 - 127.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quick_logarithm_is_good_to_a_tenth() {
        for x in [1e-3_f32, 0.3, 1.0, 5.0, 1000.0] {
            assert!((fast_log2(x) - x.log2()).abs() < 0.09);
        }
    }
}

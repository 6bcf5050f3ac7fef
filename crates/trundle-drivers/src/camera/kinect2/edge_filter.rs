//! The filter of flying pixels.
//!
//! A pixel on an edge receives light from both surfaces. Its distance is then between both surfaces, in free space. Such a pixel has few
//! neighbours with similar depth, and is removed. Source: the principle is that of \[Reynolds11\].

use super::layout::{COLUMNS, ROWS};
use trundle_core::DepthImage;

/// Difference of depth up to which a neighbour supports a pixel, as a share of the depth: 0.02. Source: ours; a surface at 75 degrees from the
/// line of sight steps by 0.01 per pixel.
const SUPPORT_SHARE: f32 = 0.02;
/// Difference of depth up to which a neighbour supports a pixel in any case \[m\]: 0.02. Source: ours; four times the noise at 4 m.
const MIN_SUPPORT_M: f32 = 0.02;
/// Minimum number of supporting neighbours, of eight: 4. Source: ours; a pixel at a straight edge has five on its own surface.
const MIN_SUPPORTERS: usize = 4;

/// Copies `depth` into `filtered` without flying pixels. The border of one pixel is copied.
pub(super) fn remove_flying_pixels(depth: &DepthImage, filtered: &mut DepthImage) {
    filtered.data_mut().copy_from_slice(depth.data());
    for y in 1..ROWS - 1 {
        let rows = [depth.row(y - 1), depth.row(y), depth.row(y + 1)];
        for (x, target) in filtered.row_mut(y).iter_mut().enumerate().take(COLUMNS - 1).skip(1) {
            if *target > 0.0 && supporters(rows, x, *target) < MIN_SUPPORTERS {
                *target = 0.0;
            }
        }
    }
}

/// Neighbours at the depth of the pixel in the middle row.
fn supporters(rows: [&[f32]; 3], x: usize, depth: f32) -> usize {
    let limit = (SUPPORT_SHARE * depth).max(MIN_SUPPORT_M);
    let supports = |other: &&f32| **other > 0.0 && (**other - depth).abs() < limit;
    let all = rows.iter().flat_map(|row| &row[x - 1..=x + 1]).filter(supports).count();
    all - 1
}

//! Whether the edges of depth lie on the edges of the colour image.

use crate::calibration_check::issue::CalibrationIssue;
use trundle_core::{DepthImage, GrayImage};

/// Images that are checked: 16. Source: ours.
const CHECKED_IMAGES: usize = 16;
/// Side of the blocks that are compared: 4 px. Source: ours.
const BLOCK_PX: usize = 4;
/// Largest shift of the depth image that is tried along a row: 12 blocks. Source: ours.
const MAX_SEARCH_X_BLOCKS: i64 = 12;
/// Largest shift that is tried along a column: 8 blocks. Source: ours.
const MAX_SEARCH_Y_BLOCKS: i64 = 8;
/// Relative difference of neighbouring depths that is an edge: 0.08. Source: ours.
const MIN_JUMP_RATIO: f32 = 0.08;
/// Largest gap without depth between the two sides of an edge: 12 px, the shadow of a depth camera. Source: ours.
const MAX_SHADOW_PX: usize = 12;
/// Excess of the image's edges under the shifted depth edges over their mean, as a fraction of it, for a registration error: 0.1.
/// Source: ours.
const MIN_CONTRAST: f64 = 0.1;
/// Ratio of that excess to the one without a shift: 1.5. Below it the registration counts as right. Source: ours.
const MIN_CONTRAST_RATIO: f64 = 1.5;
/// Largest difference between the shifts found in two halves of the images: 5 blocks. Near edges need another shift than far ones.
/// Source: ours.
const MAX_SHIFT_DIFFERENCE_BLOCKS: i64 = 5;
/// Largest plausible shift along a row: 8 blocks. A larger one is not a pair of cameras in one housing. Source: ours.
const MAX_SHIFT_X_BLOCKS: i64 = 8;
/// Largest plausible shift along a column: 6 blocks. Source: ours.
const MAX_SHIFT_Y_BLOCKS: i64 = 6;
/// Fewest blocks with a depth edge in an image: 50. An image with fewer is skipped. Source: ours.
const MIN_EDGE_BLOCKS: usize = 50;

/// Whether the edges of depth lie on the edges of the picture.
#[derive(Debug, Clone, Default)]
pub(crate) struct Registration {
    images: usize,
    /// For each shift: mean strength of the image's edges at the shifted depth edges, relative to each image's mean. The first list is of
    /// every second image, the second of the others.
    scores: [Vec<f64>; 2],
}

impl Registration {
    /// Whether more images are needed.
    fn is_open(&self) -> bool {
        self.images < CHECKED_IMAGES
    }

    /// Records an image; evaluates after [`CHECKED_IMAGES`].
    pub fn record(&mut self, gray: &GrayImage, depth: &DepthImage) -> Option<CalibrationIssue> {
        if !self.is_open() || !gray.same_size(depth) {
            return None;
        }
        let picture = Blocks::contrast(gray);
        let edges = edges_of(depth, &picture);
        let mean = picture.mean();
        if edges.len() < MIN_EDGE_BLOCKS || mean <= 0.0 {
            return None;
        }
        let shifts = (2 * MAX_SEARCH_X_BLOCKS + 1) * (2 * MAX_SEARCH_Y_BLOCKS + 1);
        let scores = &mut self.scores[self.images % 2];
        scores.resize(shifts as usize, 0.0);
        self.images += 1;
        for (score, (dx, dy)) in scores.iter_mut().zip(shifts_of()) {
            let under = edges.iter().filter_map(|(x, y)| picture.at(x + dx, y + dy));
            let (sum, count) = under.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
            *score += sum / f64::from(count.max(1)) / mean;
        }
        if self.is_open() { None } else { self.evaluate() }
    }

    /// Reports a shift if both halves of the images agree on it and its size is plausible. Without a registration error the halves
    /// disagree.
    fn evaluate(&self) -> Option<CalibrationIssue> {
        let [a, b] = [shift_of(&self.scores[0])?, shift_of(&self.scores[1])?];
        let same = (a.0 - b.0).abs() <= MAX_SHIFT_DIFFERENCE_BLOCKS
            && (a.1 - b.1).abs() <= MAX_SHIFT_DIFFERENCE_BLOCKS;
        let inside = |(dx, dy): (i64, i64)| dx.abs() <= MAX_SHIFT_X_BLOCKS && dy.abs() <= MAX_SHIFT_Y_BLOCKS;
        let px = |blocks: i64| (blocks * BLOCK_PX as i64) as f64 / 2.0;
        let offset = (px(a.0 + b.0), px(a.1 + b.1));
        (same && inside(a) && inside(b)).then_some(CalibrationIssue::Registration { offset })
    }
}

/// The shift, in blocks, that aligns depth edges with image edges clearly better than no shift.
fn shift_of(scores: &[f64]) -> Option<(i64, i64)> {
    let near = |(dx, dy): (i64, i64)| dx.abs() <= 1 && dy.abs() <= 1;
    let of = |wanted: bool| {
        let all = scores.iter().zip(shifts_of()).filter(move |(_, shift)| near(*shift) == wanted);
        all.max_by(|a, b| a.0.total_cmp(b.0)).map(|(score, shift)| (*score, shift))
    };
    let ((here, _), (there, shift)) = (of(true)?, of(false)?);
    let mean = scores.iter().sum::<f64>() / scores.len() as f64;
    let clear = there - mean > MIN_CONTRAST * mean && there - mean > MIN_CONTRAST_RATIO * (here - mean);
    clear.then_some(shift)
}

fn shifts_of() -> impl Iterator<Item = (i64, i64)> {
    (-MAX_SEARCH_Y_BLOCKS..=MAX_SEARCH_Y_BLOCKS)
        .flat_map(|dy| (-MAX_SEARCH_X_BLOCKS..=MAX_SEARCH_X_BLOCKS).map(move |dx| (dx, dy)))
}

/// A value for each block of an image.
#[derive(Debug)]
struct Blocks {
    width: usize,
    values: Vec<f64>,
}

impl Blocks {
    /// Strongest contrast between neighbouring pixels in each block.
    fn contrast(gray: &GrayImage) -> Self {
        let (width, height) = (gray.width() / BLOCK_PX, gray.height() / BLOCK_PX);
        let mut values = vec![0.0; width * height];
        for y in 0..(height * BLOCK_PX).saturating_sub(1) {
            let (row, below) = (gray.row(y), gray.row(y + 1));
            for x in 0..(width * BLOCK_PX).saturating_sub(1) {
                let strength = row[x].abs_diff(row[x + 1]).max(row[x].abs_diff(below[x]));
                let block = &mut values[y / BLOCK_PX * width + x / BLOCK_PX];
                *block = f64::max(*block, f64::from(strength));
            }
        }
        Self { width, values }
    }

    fn at(&self, x: i64, y: i64) -> Option<f64> {
        let inside = (0..self.width as i64).contains(&x) && y >= 0;
        inside.then(|| self.values.get(y as usize * self.width + x as usize).copied()).flatten()
    }

    fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len().max(1) as f64
    }
}

/// The blocks with a depth edge, on the edge's near side, which has no shadow.
fn edges_of(depth: &DepthImage, like: &Blocks) -> Vec<(i64, i64)> {
    let mut marked = vec![false; like.values.len()];
    for y in 0..depth.height() / BLOCK_PX * BLOCK_PX {
        let mut last: Option<(usize, f32)> = None;
        for (x, &here) in
            depth.row(y).iter().enumerate().take(like.width * BLOCK_PX).filter(|(_, d)| **d > 0.0)
        {
            if let Some((before, there)) = last.filter(|(before, _)| x - before <= MAX_SHADOW_PX)
                && (here - there).abs() > MIN_JUMP_RATIO * here.min(there)
            {
                let near = if here < there { x } else { before };
                marked[y / BLOCK_PX * like.width + near / BLOCK_PX] = true;
            }
            last = Some((x, here));
        }
    }
    let place = |i: usize| ((i % like.width) as i64, (i / like.width) as i64);
    marked.iter().enumerate().filter(|(_, edge)| **edge).map(|(i, _)| place(i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes of their own shade before a wall with a faint pattern; the depth image shifted to the left by `shift` px.
    fn verdict(shift: usize) -> Option<CalibrationIssue> {
        let near = |x: usize, y: usize| (x / 3 + 7 * (y / 41)) % 37 < 12 && y % 41 < 30;
        let gray =
            GrayImage::from_fn(
                320,
                240,
                |x, y| {
                    if near(x, y) { 160 } else { 70 + (x * 7 + y * 3) as u8 % 11 }
                },
            );
        let depth = DepthImage::from_fn(320, 240, |x, y| if near(x + shift, y) { 1.5 } else { 2.5 });
        let mut check = Registration::default();
        (0..2 * CHECKED_IMAGES).find_map(|_| check.record(&gray, &depth))
    }

    #[test]
    fn a_shifted_depth_image_is_noticed_and_a_registered_one_is_not() {
        assert_eq!(verdict(0), None);
        assert_eq!(verdict(2), None, "half a block");
        let offset = verdict(16).map(|s| s.to_string()).unwrap_or_default();
        assert!(offset.contains("about 16, 0 px") && offset.contains("not registered"), "{offset}");
    }

    #[test]
    fn without_edges_the_registration_is_unknown() {
        let mut check = Registration::default();
        let depth = DepthImage::from_fn(64, 64, |x, _| 1.0 + (x / 20) as f32);
        assert_eq!((0..20).find_map(|_| check.record(&GrayImage::filled(64, 64, 9), &depth)), None);
        assert_eq!(check.record(&GrayImage::filled(10, 10, 9), &depth), None);
    }
}

//! FAST-9 by exact scores. A pixel is a corner if nine contiguous ones of the sixteen on a circle of radius 3 are all brighter, or all
//! darker, by more than a threshold \[Rosten06\]. The score is the highest threshold with this property. Minima and maxima alone give the
//! score, so a register of pixels is processed per step. The score serves both thresholds and the suppression of non-maxima.

use super::OrbConfig;
use super::corner::Corner;
use super::patch::BORDER_PX;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use super::vector::{self, BLOCK_PX, Bytes, block, block_mut, starts};
use trundle_core::GrayImage;

/// Radius of the circle: 3 px. Source: \[Rosten06\].
const CIRCLE_RADIUS_PX: usize = 3;

/// The circle, (x, y) px from the corner of its square, clockwise from the top. Source: \[Rosten06\].
const CIRCLE: [(usize, usize); 16] = [
    (3, 0),
    (4, 0),
    (5, 1),
    (6, 2),
    (6, 3),
    (6, 4),
    (5, 5),
    (4, 6),
    (3, 6),
    (2, 6),
    (1, 5),
    (0, 4),
    (0, 3),
    (0, 2),
    (1, 1),
    (2, 0),
];

/// Finds corners; keeps its buffers from image to image.
#[derive(Debug, Clone, Default)]
pub(crate) struct Detector {
    scores: Vec<u8>,
    maxima: Vec<u8>,
    /// Whether each cell has a corner above the higher threshold.
    cells: Vec<bool>,
}

impl Detector {
    /// Appends the `wanted` corners of `image` that are at least [`BORDER_PX`] px from its border, row by row. They are local maxima of the
    /// score above the threshold; in cells without any, above the lower threshold. The image is larger than two borders.
    pub fn detect(
        &mut self,
        image: &GrayImage,
        config: &OrbConfig,
        wanted: impl Fn(Corner) -> bool,
        corners: &mut Vec<Corner>,
    ) {
        let size = (image.width(), image.height());
        self.score(image, config.fast_min_threshold);
        self.find_maxima(size, corners);
        corners.retain(|corner| wanted(*corner));
        let side = config.cell_px as u16;
        let across = size.0.div_ceil(config.cell_px);
        let cell = |c: &Corner| usize::from(c.y / side) * across + usize::from(c.x / side);
        self.cells.clear();
        self.cells.resize(across * size.1.div_ceil(config.cell_px), false);
        for corner in corners.iter().filter(|c| c.score > config.fast_threshold) {
            self.cells[cell(corner)] = true;
        }
        corners.retain(|c| c.score > config.fast_threshold || !self.cells[cell(c)]);
    }

    /// The scores of the last image, row by row: of every possible corner and its neighbours.
    pub fn scores(&self) -> &[u8] {
        &self.scores
    }

    /// Scores every possible corner and its neighbours.
    fn score(&mut self, image: &GrayImage, threshold: u8) {
        let (width, height) = (image.width(), image.height());
        self.scores.resize(width * height, 0);
        let around = BORDER_PX - 1 - CIRCLE_RADIUS_PX..width - (BORDER_PX - 1 - CIRCLE_RADIUS_PX);
        for y in BORDER_PX - 1..=height - BORDER_PX {
            let rows = std::array::from_fn(|k| &image.row(y + k - CIRCLE_RADIUS_PX)[around.clone()]);
            score_row(rows, threshold, &mut self.scores[y * width..][BORDER_PX - 1..=width - BORDER_PX]);
        }
    }

    fn find_maxima(&mut self, (width, height): (usize, usize), corners: &mut Vec<Corner>) {
        self.maxima.resize((width - 2 * BORDER_PX).next_multiple_of(WORD_PX), 0);
        // The last word is longer than the row: leftovers of an image of another size are no maxima.
        self.maxima[width - 2 * BORDER_PX..].fill(0);
        for y in BORDER_PX..height - BORDER_PX {
            let row = |y: usize| &self.scores[y * width..][BORDER_PX - 1..=width - BORDER_PX];
            let maxima = &mut self.maxima[..width - 2 * BORDER_PX];
            suppress_row([row(y - 1), row(y), row(y + 1)], maxima);
            for (word, scores) in self.maxima.as_chunks::<WORD_PX>().0.iter().enumerate() {
                // Most words are empty, and the others have few bits.
                let mut left = u64::from_le_bytes(*scores);
                while left != 0 {
                    let i = left.trailing_zeros() as usize / 8;
                    left &= !(0xff << (8 * i));
                    corners.push(Corner {
                        x: (BORDER_PX + WORD_PX * word + i) as u16,
                        y: y as u16,
                        score: scores[i],
                    });
                }
            }
        }
    }
}

/// Number of pixels searched together for maxima: 8. Source: ours.
const WORD_PX: usize = 8;

/// The `$best` over all arcs of nine of `$circle` of the `$worst` of its pixels, for single pixels or vectors. Two neighbouring arcs of
/// nine share eight pixels, which are halved twice.
macro_rules! best_arc {
    ($circle:expr, $worst:expr, $best:expr) => {{
        let (circle, worst, best) = ($circle, $worst, $best);
        let mut nine = [circle[0]; 8];
        let (mut two, mut four) = (nine, nine);
        for i in 0..8 {
            two[i] = worst(circle[2 * i + 1], circle[(2 * i + 2) % 16]);
        }
        for i in 0..8 {
            four[i] = worst(two[i], two[(i + 1) % 8]);
        }
        for i in 0..8 {
            let eight = worst(four[i], four[(i + 2) % 8]);
            nine[i] = worst(eight, best(circle[2 * i], circle[(2 * i + 9) % 16]));
        }
        let [a, b, c, d, e, f, g, h] = nine;
        best(best(best(a, b), best(c, d)), best(best(e, f), best(g, h)))
    }};
}

/// Scores a row of pixels, from the seven rows around it, each 2 * [`CIRCLE_RADIUS_PX`] longer than `scores`. A score up to `threshold`
/// becomes 0.
fn score_row(rows: [&[u8]; 2 * CIRCLE_RADIUS_PX + 1], threshold: u8, scores: &mut [u8]) {
    #[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
    if scores.len() >= BLOCK_PX && vector::is_available() {
        // SAFETY: the processor has the only feature that the function is compiled for.
        return unsafe { score_row_by_blocks(rows, threshold, scores) };
    }
    score_row_plainly(rows, threshold, scores);
}

fn score_row_plainly(rows: [&[u8]; 2 * CIRCLE_RADIUS_PX + 1], threshold: u8, scores: &mut [u8]) {
    for (x, out) in scores.iter_mut().enumerate() {
        let score =
            score(CIRCLE.map(|(dx, dy)| rows[dy][x + dx]), rows[CIRCLE_RADIUS_PX][x + CIRCLE_RADIUS_PX]);
        *out = if score > threshold { score } else { 0 };
    }
}

/// [`score_row_plainly`] for [`BLOCK_PX`] pixels or more, block by block.
///
/// An arc of nine contains the top or the bottom pixel of the circle, and the leftmost or the rightmost one. For most of an image, these
/// four pixels alone exclude a corner in a block; the other pixels are then not read.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
#[cfg_attr(target_arch = "x86_64", target_feature(enable = "avx2"))]
#[cfg_attr(target_arch = "aarch64", target_feature(enable = "neon"))]
fn score_row_by_blocks(rows: [&[u8]; 2 * CIRCLE_RADIUS_PX + 1], threshold: u8, scores: &mut [u8]) {
    let min = Bytes::splat(threshold.saturating_add(1));
    for x in starts(scores.len(), BLOCK_PX) {
        let mut windows = [&[0; BLOCK_PX + 2 * CIRCLE_RADIUS_PX]; 2 * CIRCLE_RADIUS_PX + 1];
        for (window, row) in windows.iter_mut().zip(rows) {
            *window = block(row, x);
        }
        let at = |(dx, dy): (usize, usize)| Bytes::load(block(windows[dy], dx));
        let middle = at((CIRCLE_RADIUS_PX, CIRCLE_RADIUS_PX));
        let beyond = |bright: Bytes, dark: Bytes| {
            let difference = bright.saturating_sub(middle).max(middle.saturating_sub(dark));
            difference.and(difference.at_least(min))
        };
        let [top, right, low, left] = [at(CIRCLE[0]), at(CIRCLE[4]), at(CIRCLE[8]), at(CIRCLE[12])];
        let bright = top.max(low).min(left.max(right));
        let dark = top.min(low).max(left.min(right));
        let mut score = beyond(bright, dark);
        if !score.is_zero() {
            let mut circle = [middle; CIRCLE.len()];
            for (pixels, offset) in circle.iter_mut().zip(CIRCLE) {
                *pixels = at(offset);
            }
            let bright = best_arc!(circle, |a: Bytes, b| a.min(b), |a: Bytes, b| a.max(b));
            let dark = best_arc!(circle, |a: Bytes, b| a.max(b), |a: Bytes, b| a.min(b));
            score = beyond(bright, dark);
        }
        score.store(block_mut(scores, x));
    }
}

/// The highest over all arcs of nine of the smallest difference between the arc and the middle; 0 if none is on one side.
fn score(circle: [u8; 16], middle: u8) -> u8 {
    let brightest = best_arc!(circle, u8::min, u8::max);
    let darkest = best_arc!(circle, u8::max, u8::min);
    brightest.saturating_sub(middle).max(middle.saturating_sub(darkest))
}

/// Keeps the scores that none of the eight neighbours exceeds, and of equal neighbours the first; the others become 0. The
/// rows are those above, of and below `maxima`, each one longer at either end.
fn suppress_row(rows: [&[u8]; 3], maxima: &mut [u8]) {
    #[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
    if maxima.len() >= BLOCK_PX && vector::is_available() {
        // SAFETY: the processor has the only feature that the function is compiled for.
        return unsafe { suppress_row_by_blocks(rows, maxima) };
    }
    suppress_row_plainly(rows, maxima);
}

fn suppress_row_plainly([above, own, below]: [&[u8]; 3], maxima: &mut [u8]) {
    for (x, out) in maxima.iter_mut().enumerate() {
        let before = above[x].max(above[x + 1]).max(above[x + 2]).max(own[x]);
        let after = own[x + 2].max(below[x]).max(below[x + 1]).max(below[x + 2]);
        *out = if own[x + 1] > before && own[x + 1] >= after { own[x + 1] } else { 0 };
    }
}

/// [`suppress_row_plainly`] for [`BLOCK_PX`] pixels or more, block by block.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
#[cfg_attr(target_arch = "x86_64", target_feature(enable = "avx2"))]
#[cfg_attr(target_arch = "aarch64", target_feature(enable = "neon"))]
fn suppress_row_by_blocks(rows: [&[u8]; 3], maxima: &mut [u8]) {
    for x in starts(maxima.len(), BLOCK_PX) {
        let windows: [&[u8; BLOCK_PX + 2]; 3] = rows.map(|row| block(row, x));
        let at = |row: usize, dx: usize| Bytes::load(block(windows[row], dx));
        let own = at(1, 1);
        let mut kept = own;
        if !own.is_zero() {
            let before = at(0, 0).max(at(0, 1)).max(at(0, 2).max(at(1, 0)));
            let after = at(1, 2).max(at(2, 0)).max(at(2, 1).max(at(2, 2)));
            kept = own.and(own.at_least(after).and_not(before.at_least(own)));
        }
        kept.store(block_mut(maxima, x));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The definition, word for word.
    fn is_corner(circle: [u8; 16], middle: u8, threshold: u8) -> bool {
        let (p, t) = (i32::from(middle), i32::from(threshold));
        (0..16).any(|start| {
            let arc = || (0..9).map(|k| i32::from(circle[(start + k) % 16]));
            arc().all(|q| q > p + t) || arc().all(|q| q < p - t)
        })
    }

    proptest! {
        #[test]
        fn the_score_is_where_the_definition_turns(circle: [u8; 16], middle: u8) {
            let score = score(circle, middle);
            prop_assert!(!is_corner(circle, middle, score));
            prop_assert!(score == 0 || is_corner(circle, middle, score - 1));
        }

        #[test]
        fn arcs_of_nine_are_found_wherever_they_start(start in 0..16usize, bright in 150..255u8, dark in 0..100u8) {
            let arc = |length: usize| std::array::from_fn(|i| {
                if (i + 16 - start) % 16 < length { bright } else { dark }
            });
            prop_assert_eq!(score(arc(9), dark), bright - dark);
            prop_assert_eq!(score(arc(8), dark), 0);
        }
    }

    proptest! {
        #[test]
        fn many_pixels_at_once_change_nothing(
            rows in prop::collection::vec(any::<[u8; 7]>(), 7..150), contrast in 0..8u32, threshold in 1..60u8,
        ) {
            let row = |k: usize| rows.iter().map(|pixels| pixels[k] >> contrast).collect::<Vec<u8>>();
            let rows: [Vec<u8>; 7] = std::array::from_fn(row);
            let mut scores = vec![1; rows[0].len() - 6];
            let mut plainly = scores.clone();
            score_row(rows.each_ref().map(Vec::as_slice), threshold, &mut scores);
            score_row_plainly(rows.each_ref().map(Vec::as_slice), threshold, &mut plainly);
            prop_assert_eq!(&scores, &plainly);
            let three = [&rows[0][..], &rows[1], &rows[2]];
            let mut maxima = vec![1; rows[0].len() - 2];
            let mut plainly = maxima.clone();
            suppress_row(three, &mut maxima);
            suppress_row_plainly(three, &mut plainly);
            prop_assert_eq!(maxima, plainly);
        }
    }

    fn detected(image: &GrayImage) -> Vec<Corner> {
        let mut corners = Vec::new();
        Detector::default().detect(image, &OrbConfig::default(), |_| true, &mut corners);
        corners
    }

    #[test]
    fn a_square_has_four_corners_where_they_are() {
        let inside = |v: usize| (30..50).contains(&v);
        let image = GrayImage::from_fn(80, 80, |x, y| if inside(x) && inside(y) { 200 } else { 50 });
        let corners = detected(&image);
        assert_eq!(corners.len(), 4, "{corners:?}");
        for (corner, at) in corners.iter().zip([(30, 30), (49, 30), (30, 49), (49, 49)]) {
            // All pixels of the corner's tip have the same score in a noiseless picture: the first one is used.
            assert!(corner.x.abs_diff(at.0) <= 2 && corner.y.abs_diff(at.1) <= 2, "{corner:?} {at:?}");
            assert_eq!(corner.score, 150);
        }
    }

    #[test]
    fn edges_and_plain_walls_have_none() {
        assert_eq!(detected(&GrayImage::filled(80, 80, 90)), vec![]);
        assert_eq!(detected(&GrayImage::from_fn(80, 80, |x, _| if x < 40 { 10 } else { 240 })), vec![]);
    }

    /// Single bright pixels at `points`, each over a background of 50 by its contrast.
    fn dots(points: &[(usize, usize, u8)]) -> GrayImage {
        let mut image = GrayImage::filled(96, 96, 50);
        points.iter().for_each(|&(x, y, contrast)| image[(x, y)] = 50 + contrast);
        image
    }

    #[test]
    fn the_lower_threshold_serves_only_cells_that_stay_empty() {
        let corners = detected(&dots(&[(40, 40, 90), (52, 52, 12), (76, 76, 12), (70, 40, 7)]));
        assert_eq!(corners, vec![Corner { x: 40, y: 40, score: 90 }, Corner { x: 76, y: 76, score: 12 }]);
    }

    #[test]
    fn no_corner_is_nearer_to_the_border_than_can_be_described() {
        let corners = detected(&dots(&[(15, 40, 90), (16, 50, 90), (79, 60, 90), (80, 70, 90)]));
        assert_eq!(corners.iter().map(|c| c.x).collect::<Vec<_>>(), vec![16, 79]);
    }

    #[test]
    fn of_equal_neighbours_the_first_is_kept() {
        let corners = detected(&dots(&[(40, 40, 90), (41, 40, 90)]));
        assert_eq!(corners.iter().map(|c| (c.x, c.y)).collect::<Vec<_>>(), vec![(40, 40)]);
    }
}

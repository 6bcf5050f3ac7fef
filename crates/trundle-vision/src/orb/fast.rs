//! FAST-9 by exact scores: a pixel is a corner if nine contiguous ones of the sixteen on a circle of radius 3 around it
//! are all brighter, or all darker, than it by more than a threshold \[Rosten06\]. The score is the highest threshold
//! below which that holds. It comes from minima and maxima alone, so that sixteen and more pixels are done at a time, and
//! serves both thresholds and the suppression of non-maxima.

use super::{OrbConfig, patch::BORDER};
use trundle_core::GrayImage;

/// A corner of a level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Corner {
    pub x: u16,
    pub y: u16,
    /// Least difference of its arc from it, grey values.
    pub score: u8,
}

/// Radius of the circle, px.
const RADIUS: usize = 3;

/// The circle, (x, y) px from the corner of its square, clockwise from the top.
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

/// Rows are worked on in blocks of so many pixels: what the compiler makes of the loops takes 16 at once, and single
/// pixels at the end of a row cost as much as a block each.
const BLOCK: usize = 16;

/// Finds corners; keeps its buffers from image to image.
#[derive(Debug, Clone, Default)]
pub(crate) struct Detector {
    scores: Vec<u8>,
    maxima: Vec<u8>,
    /// Whether each cell has a corner above the higher threshold.
    cells: Vec<bool>,
}

impl Detector {
    /// Appends the corners of `image` that are at least [`BORDER`] px from its border, row by row: local maxima of the
    /// score above the threshold, and in cells that have none, above the lower one. The image is larger than two borders.
    pub fn detect(&mut self, image: &GrayImage, config: &OrbConfig, corners: &mut Vec<Corner>) {
        let size = (image.width(), image.height());
        self.score(image);
        self.find_maxima(size, config.fast_min_threshold, corners);
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

    /// The scores of the last image, row by row: of every pixel that can be kept, and its neighbours.
    pub fn scores(&self) -> &[u8] {
        &self.scores
    }

    /// Scores every pixel that can be kept or is a neighbour of one, and some beside them to fill the blocks.
    fn score(&mut self, image: &GrayImage) {
        let (width, height) = (image.width(), image.height());
        self.scores.resize(width * height, 0);
        let needed = width - 2 * (BORDER - 1);
        let length = needed.next_multiple_of(BLOCK);
        // The surplus goes to the left as far as the circle lets it, the rest to the right: there is room for it all.
        let start = BORDER - 1 - (length - needed).min(BORDER - 1 - RADIUS);
        for y in BORDER - 1..=height - BORDER {
            let around = start - RADIUS..start + length + RADIUS;
            let rows = std::array::from_fn(|k| &image.row(y + k - RADIUS)[around.clone()]);
            score_row(rows, &mut self.scores[y * width + start..][..length]);
        }
    }

    fn find_maxima(&mut self, (width, height): (usize, usize), threshold: u8, corners: &mut Vec<Corner>) {
        let right = (width - BORDER) as u16;
        let length = (width - 2 * BORDER).next_multiple_of(BLOCK);
        self.maxima.resize(length, 0);
        for y in BORDER..height - BORDER {
            let row = |y: usize| &self.scores[y * width + BORDER - 1..][..length + 2];
            suppress_row([row(y - 1), row(y), row(y + 1)], threshold, &mut self.maxima);
            for (block, scores) in self.maxima.as_chunks().0.iter().enumerate() {
                // Most blocks are empty, and the others nearly.
                let mut left = u128::from_le_bytes(*scores);
                while left != 0 {
                    let i = left.trailing_zeros() as usize / 8;
                    left &= !(0xff << (8 * i));
                    let x = (BORDER + BLOCK * block + i) as u16;
                    if x < right {
                        corners.push(Corner { x, y: y as u16, score: scores[i] });
                    }
                }
            }
        }
    }
}

/// Scores a row of pixels, from the seven rows around it, each 2 * [`RADIUS`] longer than `scores`. Written out, slice by
/// slice, because the compiler vectorises it only so, and that makes it 200 times as fast.
fn score_row(rows: [&[u8]; 2 * RADIUS + 1], scores: &mut [u8]) {
    let length = scores.len();
    let [a, b, c, d, e, f, g, h, j, k, l, m, n, o, p, q] = CIRCLE.map(|(x, y)| &rows[y][x..x + length]);
    let middle = &rows[RADIUS][RADIUS..RADIUS + length];
    for i in 0..length {
        let circle =
            [a[i], b[i], c[i], d[i], e[i], f[i], g[i], h[i], j[i], k[i], l[i], m[i], n[i], o[i], p[i], q[i]];
        scores[i] = score(circle, middle[i]);
    }
}

/// The highest over all arcs of nine of the least difference between the arc and the middle; 0 if none is on one side.
#[inline(always)]
fn score(circle: [u8; 16], middle: u8) -> u8 {
    let brightest = best_arc(circle, u8::min, u8::max);
    let darkest = best_arc(circle, u8::max, u8::min);
    brightest.saturating_sub(middle).max(middle.saturating_sub(darkest))
}

/// The `best` over all arcs of nine of the `worst` of its pixels. Two arcs of nine share eight; the eight halve twice.
#[inline(always)]
fn best_arc(circle: [u8; 16], worst: impl Fn(u8, u8) -> u8, best: impl Fn(u8, u8) -> u8) -> u8 {
    let two = |i: usize| worst(circle[2 * i + 1], circle[(2 * i + 2) % 16]);
    let four = |i: usize| worst(two(i), two((i + 1) % 8));
    let eight = |i: usize| worst(four(i), four((i + 2) % 8));
    let nine = |i: usize| worst(eight(i), best(circle[2 * i], circle[(2 * i + 9) % 16]));
    let best_of_four = |i: usize| best(best(nine(i), nine(i + 1)), best(nine(i + 2), nine(i + 3)));
    best(best_of_four(0), best_of_four(4))
}

/// Keeps the scores above `threshold` that none of the eight neighbours exceeds, and of equal neighbours the first; the
/// others become 0. The rows are those above, of and below `maxima`, each one longer at either end.
fn suppress_row(rows: [&[u8]; 3], threshold: u8, maxima: &mut [u8]) {
    let length = maxima.len();
    let [[a, b, c], [d, e, f], [g, h, j]] =
        rows.map(|row| [&row[..length], &row[1..length + 1], &row[2..length + 2]]);
    for i in 0..length {
        let before = a[i].max(b[i]).max(c[i]).max(d[i]);
        let after = f[i].max(g[i]).max(h[i]).max(j[i]);
        let keep = (e[i] > threshold) & (e[i] > before) & (e[i] >= after);
        maxima[i] = if keep { e[i] } else { 0 };
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

    fn detected(image: &GrayImage) -> Vec<Corner> {
        let mut corners = Vec::new();
        Detector::default().detect(image, &OrbConfig::default(), &mut corners);
        corners
    }

    #[test]
    fn a_square_has_four_corners_where_they_are() {
        let inside = |v: usize| (30..50).contains(&v);
        let image = GrayImage::from_fn(80, 80, |x, y| if inside(x) && inside(y) { 200 } else { 50 });
        let corners = detected(&image);
        assert_eq!(corners.len(), 4, "{corners:?}");
        for (corner, at) in corners.iter().zip([(30, 30), (49, 30), (30, 49), (49, 49)]) {
            // All pixels of the corner's tip score the same in so clean a picture: the first of them counts.
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
    fn none_is_nearer_to_the_border_than_can_be_described() {
        let corners = detected(&dots(&[(15, 40, 90), (16, 50, 90), (79, 60, 90), (80, 70, 90)]));
        assert_eq!(corners.iter().map(|c| c.x).collect::<Vec<_>>(), vec![16, 79]);
    }

    #[test]
    fn of_equal_neighbours_the_first_is_kept() {
        let corners = detected(&dots(&[(40, 40, 90), (41, 40, 90)]));
        assert_eq!(corners.iter().map(|c| (c.x, c.y)).collect::<Vec<_>>(), vec![(40, 40)]);
    }
}

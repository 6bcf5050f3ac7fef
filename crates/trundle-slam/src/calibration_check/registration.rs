use crate::calibration_check::issue::CalibrationIssue;
use trundle_core::{DepthImage, GrayImage};

/// Images that are looked at.
const IMAGES: usize = 16;
/// Side of the blocks of pixels that are compared, px.
const BLOCK: usize = 4;
/// How far the depth image may be shifted, blocks to each side.
const REACH: (i64, i64) = (12, 8);
/// A jump of depth between neighbours by more than this part of it is an edge.
const JUMP: f32 = 0.08;
/// How far apart along a row the two sides of an edge may be, px: depth cameras see nothing in the shadow between.
const SHADOW: usize = 12;
/// How much stronger than their mean the picture's edges must be under the shifted edges of depth, as a part of it.
const LEAST_CONTRAST: f64 = 0.1;
/// How many times as much stronger than without a shift.
const CLEAR: f64 = 1.5;
/// How far apart the shifts may be that both halves of the images ask for, blocks: what is near needs another one than what
/// is far.
const SAME: i64 = 5;
/// Farther shifts than this, blocks, no pair of cameras in one housing asks for.
const MOST: (i64, i64) = (8, 6);
/// Fewer edge blocks than this in an image say nothing.
const LEAST: usize = 50;

/// Whether the edges of depth lie on the edges of the picture.
#[derive(Debug, Clone, Default)]
pub(crate) struct Registration {
    images: usize,
    /// By shift: how strong the picture's edges are under the shifted edges of depth, each image's mean being 1; of every
    /// second image, and of the others.
    scores: [Vec<f64>; 2],
}

impl Registration {
    /// Whether it still wants images.
    fn is_open(&self) -> bool {
        self.images < IMAGES
    }

    /// Takes an image; judges after some.
    pub fn record(&mut self, gray: &GrayImage, depth: &DepthImage) -> Option<CalibrationIssue> {
        if !self.is_open() || !gray.same_size(depth) {
            return None;
        }
        let picture = Blocks::contrast(gray);
        let edges = edges_of(depth, &picture);
        let mean = picture.mean();
        if edges.len() < LEAST || mean <= 0.0 {
            return None;
        }
        let shifts = (2 * REACH.0 + 1) * (2 * REACH.1 + 1);
        let scores = &mut self.scores[self.images % 2];
        scores.resize(shifts as usize, 0.0);
        self.images += 1;
        for (score, (dx, dy)) in scores.iter_mut().zip(shifts_of()) {
            let under = edges.iter().filter_map(|(x, y)| picture.at(x + dx, y + dy));
            let (sum, count) = under.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
            *score += sum / f64::from(count.max(1)) / mean;
        }
        if self.is_open() { None } else { self.judge() }
    }

    /// Both halves of the images must ask for about the same shift, and not for one out of all reason: where there is nothing
    /// to find, they do not.
    fn judge(&self) -> Option<CalibrationIssue> {
        let [a, b] = [shift_of(&self.scores[0])?, shift_of(&self.scores[1])?];
        let same = (a.0 - b.0).abs() <= SAME && (a.1 - b.1).abs() <= SAME;
        let inside = |(dx, dy): (i64, i64)| dx.abs() <= MOST.0 && dy.abs() <= MOST.1;
        let px = |blocks: i64| (blocks * BLOCK as i64) as f64 / 2.0;
        let offset = (px(a.0 + b.0), px(a.1 + b.1));
        (same && inside(a) && inside(b)).then_some(CalibrationIssue::Registration { offset })
    }
}

/// The shift, in blocks, that puts the edges of depth clearly better onto those of the picture than none does.
fn shift_of(scores: &[f64]) -> Option<(i64, i64)> {
    let near = |(dx, dy): (i64, i64)| dx.abs() <= 1 && dy.abs() <= 1;
    let of = |wanted: bool| {
        let all = scores.iter().zip(shifts_of()).filter(move |(_, shift)| near(*shift) == wanted);
        all.max_by(|a, b| a.0.total_cmp(b.0)).map(|(score, shift)| (*score, shift))
    };
    let ((here, _), (there, shift)) = (of(true)?, of(false)?);
    let mean = scores.iter().sum::<f64>() / scores.len() as f64;
    let clear = there - mean > LEAST_CONTRAST * mean && there - mean > CLEAR * (here - mean);
    clear.then_some(shift)
}

fn shifts_of() -> impl Iterator<Item = (i64, i64)> {
    (-REACH.1..=REACH.1).flat_map(|dy| (-REACH.0..=REACH.0).map(move |dx| (dx, dy)))
}

/// A value for each block of an image.
#[derive(Debug)]
struct Blocks {
    width: usize,
    values: Vec<f64>,
}

impl Blocks {
    /// The strongest contrast between neighbouring pixels in each block.
    fn contrast(gray: &GrayImage) -> Self {
        let (width, height) = (gray.width() / BLOCK, gray.height() / BLOCK);
        let mut values = vec![0.0; width * height];
        for y in 0..(height * BLOCK).saturating_sub(1) {
            let (row, below) = (gray.row(y), gray.row(y + 1));
            for x in 0..(width * BLOCK).saturating_sub(1) {
                let strength = row[x].abs_diff(row[x + 1]).max(row[x].abs_diff(below[x]));
                let block = &mut values[y / BLOCK * width + x / BLOCK];
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

/// The blocks in which something ends before what is behind it; on the side of what is near, which has no shadow.
fn edges_of(depth: &DepthImage, like: &Blocks) -> Vec<(i64, i64)> {
    let mut marked = vec![false; like.values.len()];
    for y in 0..depth.height() / BLOCK * BLOCK {
        let mut last: Option<(usize, f32)> = None;
        for (x, &here) in depth.row(y).iter().enumerate().take(like.width * BLOCK).filter(|(_, d)| **d > 0.0)
        {
            if let Some((before, there)) = last.filter(|(before, _)| x - before <= SHADOW)
                && (here - there).abs() > JUMP * here.min(there)
            {
                let near = if here < there { x } else { before };
                marked[y / BLOCK * like.width + near / BLOCK] = true;
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
        (0..2 * IMAGES).find_map(|_| check.record(&gray, &depth))
    }

    #[test]
    fn a_shifted_depth_image_is_noticed_and_a_registered_one_is_not() {
        assert_eq!(verdict(0), None);
        assert_eq!(verdict(2), None, "half a block");
        let offset = verdict(16).map(|s| s.to_string()).unwrap_or_default();
        assert!(offset.contains("about 16, 0 px") && offset.contains("not registered"), "{offset}");
    }

    #[test]
    fn a_picture_without_edges_says_nothing() {
        let mut check = Registration::default();
        let depth = DepthImage::from_fn(64, 64, |x, _| 1.0 + (x / 20) as f32);
        assert_eq!((0..20).find_map(|_| check.record(&GrayImage::filled(64, 64, 9), &depth)), None);
        assert_eq!(check.record(&GrayImage::filled(10, 10, 9), &depth), None);
    }
}

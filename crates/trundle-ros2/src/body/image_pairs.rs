//! Colour and depth images of one moment, paired by their stamps.

use std::collections::VecDeque;
use trundle_core::Stamp;

/// Largest difference of the stamps of a pair \[s\]: at 1 rad/s and 525 px focal length, 5 px. Source: ours.
pub const MAX_PAIR_GAP_S: f64 = 0.01;
/// Maximum number of images of either kind waiting for their partner: 0.3 s at 30 Hz. Source: ours.
const MAX_WAITING: usize = 10;

/// Pairs images of two kinds by their stamps.
#[derive(Debug)]
pub struct ImagePairs<C, D> {
    colors: VecDeque<(Stamp, C)>,
    depths: VecDeque<(Stamp, D)>,
    /// Number of successive images without a partner, and the smallest gap to a possible partner \[s\].
    unpaired: (usize, f64),
}

impl<C, D> Default for ImagePairs<C, D> {
    fn default() -> Self {
        Self { colors: VecDeque::new(), depths: VecDeque::new(), unpaired: (0, f64::INFINITY) }
    }
}

impl<C, D> ImagePairs<C, D> {
    /// Adds a colour image; returns the completed pair, if any.
    pub fn add_color(&mut self, stamp: Stamp, color: C) -> Option<(C, D)> {
        let found = take_nearest(&mut self.depths, stamp, &mut self.unpaired);
        match found {
            Some(depth) => {
                drop_until(&mut self.colors, stamp);
                Some((color, depth))
            }
            None => {
                push(&mut self.colors, stamp, color);
                None
            }
        }
    }

    /// Adds a depth image; returns the completed pair, if any.
    pub fn add_depth(&mut self, stamp: Stamp, depth: D) -> Option<(C, D)> {
        let found = take_nearest(&mut self.colors, stamp, &mut self.unpaired);
        match found {
            Some(color) => {
                drop_until(&mut self.depths, stamp);
                Some((color, depth))
            }
            None => {
                push(&mut self.depths, stamp, depth);
                None
            }
        }
    }

    /// The smallest difference of the stamps \[s\] if many consecutive images found no partner although both kinds arrive.
    #[must_use]
    pub fn smallest_gap(&self) -> Option<f64> {
        let (count, gap) = self.unpaired;
        (count > 2 * MAX_WAITING && gap.is_finite()).then_some(gap)
    }
}

/// Takes the image nearest to `stamp` out of a queue, with all before it.
fn take_nearest<T>(queue: &mut VecDeque<(Stamp, T)>, stamp: Stamp, unpaired: &mut (usize, f64)) -> Option<T> {
    let gap = |(other, _): &(Stamp, T)| (*other - stamp).abs();
    let nearest = (0..queue.len()).min_by(|a, b| gap(&queue[*a]).total_cmp(&gap(&queue[*b])));
    let distance = nearest.map_or(f64::INFINITY, |i| gap(&queue[i]));
    if distance > MAX_PAIR_GAP_S {
        *unpaired = (unpaired.0 + 1, unpaired.1.min(distance));
        return None;
    }
    *unpaired = (0, f64::INFINITY);
    queue.drain(..nearest?);
    queue.pop_front().map(|(_, image)| image)
}

fn drop_until<T>(queue: &mut VecDeque<(Stamp, T)>, stamp: Stamp) {
    queue.retain(|(other, _)| *other > stamp);
}

/// Adds to a queue; the oldest leaves a full one.
fn push<T>(queue: &mut VecDeque<(Stamp, T)>, stamp: Stamp, image: T) {
    if queue.len() >= MAX_WAITING {
        queue.pop_front();
    }
    queue.push_back((stamp, image));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: i64) -> Stamp {
        Stamp::from_nanos(ms * 1_000_000)
    }

    #[test]
    fn images_of_one_moment_meet_in_either_order() {
        let mut pairs = ImagePairs::default();
        assert_eq!(pairs.add_color(at(0), 'a'), None);
        assert_eq!(pairs.add_color(at(33), 'b'), None);
        assert_eq!(pairs.add_depth(at(34), 1), Some(('b', 1)));
        assert_eq!(pairs.add_depth(at(66), 2), None);
        assert_eq!(pairs.add_color(at(66), 'c'), Some(('c', 2)));
        assert_eq!(pairs.add_depth(at(1), 3), None, "the colour image of 0 ms left with its successor");
        assert_eq!(pairs.smallest_gap(), None);
    }

    #[test]
    fn streams_that_never_meet_are_named_and_take_no_memory() {
        let mut pairs = ImagePairs::default();
        for i in 0..1000 {
            assert_eq!(pairs.add_color(at(33 * i), ()), None);
            assert_eq!(pairs.add_depth(at(33 * i + 15), ()), None);
        }
        assert!((pairs.smallest_gap().unwrap() - 0.015).abs() < 1e-9);
        assert!(pairs.colors.len() <= MAX_WAITING && pairs.depths.len() <= MAX_WAITING);
    }
}

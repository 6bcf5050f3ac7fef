//! Keeps matches whose keypoints turn alike.

use crate::{Keypoint, Match};
use std::f32::consts::TAU;

/// Bins over the circle: 30, of 12 deg each. Source: \[MurArtal17\].
const ROTATION_BINS: usize = 30;

/// The matches in the three fullest bins of a histogram of angle differences, in their old order.
///
/// A rotation of the camera around its optical axis turns all keypoints by the same angle. A match with another angle is probably wrong.
/// Of two equally full bins, the one with the smaller angle counts. `a` and `b` are the keypoints to which the indices of the matches
/// refer. Panics when an index is out of range.
pub fn rotation_consistent(matches: &[Match], a: &[Keypoint], b: &[Keypoint]) -> Vec<Match> {
    let bin = |m: &Match| {
        let turn = (b[m.b].angle - a[m.a].angle).rem_euclid(TAU) / TAU;
        (turn * ROTATION_BINS as f32) as usize % ROTATION_BINS
    };
    let mut histogram = [0; ROTATION_BINS];
    matches.iter().for_each(|m| histogram[bin(m)] += 1);
    let mut by_size: [usize; ROTATION_BINS] = std::array::from_fn(|i| i);
    by_size.sort_by_key(|&i| std::cmp::Reverse(histogram[i]));
    matches.iter().filter(|m| by_size[..3].contains(&bin(m))).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keypoint(angle: f32) -> Keypoint {
        Keypoint { x: 0.0, y: 0.0, octave: 0, angle, response: 0.0 }
    }

    #[test]
    fn pairs_with_a_different_rotation_are_dropped() {
        let a: Vec<Keypoint> = (0..50).map(|i| keypoint(i as f32 * 0.12 - 3.0)).collect();
        let mut b: Vec<Keypoint> = a.iter().map(|k| keypoint((k.angle + 0.6 + TAU) % TAU)).collect();
        for i in [3, 17, 40] {
            b[i].angle += 1.0 + i as f32 / 20.0;
        }
        let matches: Vec<Match> = (0..50).map(|i| Match { a: i, b: i, distance: 0 }).collect();
        let kept: Vec<usize> = rotation_consistent(&matches, &a, &b).iter().map(|m| m.a).collect();
        assert!((0..50).filter(|i| ![3, 17, 40].contains(i)).all(|i| kept.contains(&i)));
        assert!(kept.len() <= 49, "at most two of the three wrong matches share a bin that is kept");
    }

    #[test]
    fn no_pairs_give_no_pairs() {
        assert_eq!(rotation_consistent(&[], &[], &[]), vec![]);
    }
}

//! Distributes corners evenly over an image.

use super::corner::Corner;
use std::cmp::Reverse;

/// Appends `quota` of the `corners` to `chosen`, or all if fewer exist, evenly distributed over an image of this size.
///
/// The image is halved repeatedly across its longer side, together with the quota. A quota unused by one half is given to the other. Below
/// a quota of [`MAX_LEAF_CORNERS`], the strongest corners are selected. Cost: n log n. The order of the `corners` changes; that of `chosen`
/// is deterministic.
pub(crate) fn choose(
    corners: &mut [Corner],
    (width, height): (usize, usize),
    quota: usize,
    chosen: &mut Vec<Corner>,
) {
    let area = Area { left: 0, right: width as u32, top: 0, bottom: height as u32 };
    choose_in(area, corners, quota, chosen);
}

/// Maximum number of corners of one part that are selected by strength: 3. A value of one would distribute corners more evenly; three give
/// a tenth more inliers between frames of TUM freiburg1_rpy. Source: ours.
const MAX_LEAF_CORNERS: usize = 3;

/// A rectangle of pixels, right and bottom exclusive.
#[derive(Clone, Copy)]
struct Area {
    left: u32,
    right: u32,
    top: u32,
    bottom: u32,
}

impl Area {
    fn halves(self) -> (Self, Self) {
        if self.right - self.left >= self.bottom - self.top {
            let middle = (self.left + self.right) / 2;
            (Self { right: middle, ..self }, Self { left: middle, ..self })
        } else {
            let middle = (self.top + self.bottom) / 2;
            (Self { bottom: middle, ..self }, Self { top: middle, ..self })
        }
    }

    /// Whether a corner of the whole is in the first half.
    fn is_before_end(self, corner: Corner) -> bool {
        u32::from(corner.x) < self.right && u32::from(corner.y) < self.bottom
    }
}

fn choose_in(area: Area, corners: &mut [Corner], quota: usize, chosen: &mut Vec<Corner>) {
    if corners.len() <= quota {
        chosen.extend_from_slice(corners);
    } else if quota <= MAX_LEAF_CORNERS {
        corners.sort_unstable_by_key(|c| (Reverse(c.score), c.y, c.x));
        chosen.extend_from_slice(&corners[..quota]);
    } else {
        let (area_a, area_b) = area.halves();
        let (a, b) = partition(corners, |corner| area_a.is_before_end(corner));
        let (quota_a, quota_b) = share(quota, a.len(), b.len());
        choose_in(area_a, a, quota_a, chosen);
        choose_in(area_b, b, quota_b, chosen);
    }
}

/// Half of the quota each, the odd one to the larger, and what one has too few for to the other.
fn share(quota: usize, a: usize, b: usize) -> (usize, usize) {
    let fair_a = if a >= b { quota.div_ceil(2) } else { quota / 2 };
    let for_b = (quota - fair_a.min(a)).min(b);
    (quota - for_b, for_b)
}

/// The corners that satisfy `is_first`, and the others.
fn partition(corners: &mut [Corner], is_first: impl Fn(Corner) -> bool) -> (&mut [Corner], &mut [Corner]) {
    let mut boundary = 0;
    for i in 0..corners.len() {
        if is_first(corners[i]) {
            corners.swap(i, boundary);
            boundary += 1;
        }
    }
    corners.split_at_mut(boundary)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    fn any_corners() -> impl Strategy<Value = Vec<Corner>> {
        prop::collection::btree_map((0..64u16, 0..48u16), 0..=255u8, 0..200)
            .prop_map(|corners| corners.into_iter().map(|((x, y), score)| Corner { x, y, score }).collect())
    }

    fn chosen(corners: &[Corner], quota: usize) -> Vec<Corner> {
        let mut out = Vec::new();
        choose(&mut corners.to_vec(), (64, 48), quota, &mut out);
        out
    }

    proptest! {
        #[test]
        fn the_quota_is_met_without_repeats(corners in any_corners(), quota in 0..250usize) {
            let out = chosen(&corners, quota);
            prop_assert_eq!(out.len(), quota.min(corners.len()));
            let distinct: BTreeSet<_> = out.iter().map(|c| (c.x, c.y)).collect();
            prop_assert_eq!(distinct.len(), out.len());
            prop_assert!(out.iter().all(|c| corners.contains(c)));
        }

        #[test]
        fn the_strongest_one_is_taken(corners in any_corners()) {
            let best = corners.iter().map(|c| c.score).max();
            prop_assert_eq!(chosen(&corners, 1).first().map(|c| c.score), best);
        }
    }

    #[test]
    fn a_dense_cluster_does_not_displace_a_lonely_corner() {
        let mut corners: Vec<Corner> =
            (0..400).map(|i| Corner { x: i % 20, y: i / 20, score: 200 }).collect();
        let lonely = Corner { x: 60, y: 40, score: 8 };
        corners.push(lonely);
        assert!(chosen(&corners, 2 * MAX_LEAF_CORNERS).contains(&lonely));
    }
}

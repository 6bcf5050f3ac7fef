//! Association of colour and depth images by time stamp.

use trundle_core::Stamp;

/// Pairs (index of colour, index of depth) in order of time. Each colour image is paired with the nearest depth image in time, the earlier
/// of two equally near ones, within `max_difference` s. A depth image may be paired with two colour images: after a dropped depth image,
/// its neighbour is the best one. Both lists are sorted by time.
pub(crate) fn pair_nearest(color: &[Stamp], depth: &[Stamp], max_difference: f64) -> Vec<(usize, usize)> {
    let limit = (max_difference * 1e9).round() as u64;
    let gap = |c: &Stamp, j: usize| depth[j].nanos.abs_diff(c.nanos);
    let nearest = |c: &Stamp| {
        let after = depth.partition_point(|d| d < c);
        let candidates = after.saturating_sub(1)..(after + 1).min(depth.len());
        candidates.min_by_key(|&j| gap(c, j)).filter(|&j| gap(c, j) <= limit)
    };
    color.iter().enumerate().filter_map(|(i, c)| nearest(c).map(|j| (i, j))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn stamps(millis: &[i64]) -> Vec<Stamp> {
        millis.iter().map(|ms| Stamp::from_nanos(ms * 1_000_000)).collect()
    }

    #[test]
    fn each_colour_image_takes_the_nearest_depth_image() {
        let pairs = pair_nearest(&stamps(&[0, 15, 100]), &stamps(&[12, 30, 121]), 0.02);
        assert_eq!(pairs, [(0, 0), (1, 0)]); // 100-121 is too far
        assert_eq!(pair_nearest(&stamps(&[0, 30]), &stamps(&[20, 50]), 0.02), [(0, 0), (1, 0)]);
        assert_eq!(pair_nearest(&stamps(&[0, 30]), &stamps(&[20, 50]), 0.0), []);
        assert_eq!(pair_nearest(&stamps(&[0, 30]), &[], 0.02), []);
    }

    proptest! {
        #[test]
        fn the_same_as_looking_at_all(
            a in prop::collection::btree_set(0i64..300, 0..30),
            b in prop::collection::btree_set(0i64..300, 0..30),
        ) {
            let (a, b) = (stamps(&Vec::from_iter(a)), stamps(&Vec::from_iter(b)));
            let gap = |i: usize, j: usize| a[i].nanos.abs_diff(b[j].nanos);
            let best = |i: usize| (0..b.len()).min_by_key(|&j| gap(i, j)).filter(|&j| gap(i, j) <= 20_000_000);
            let expected: Vec<_> = (0..a.len()).filter_map(|i| best(i).map(|j| (i, j))).collect();
            prop_assert_eq!(pair_nearest(&a, &b, 0.02), expected);
        }
    }
}

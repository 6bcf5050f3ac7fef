use trundle_core::Stamp;

/// Pairs (index of colour, index of depth) by rising time: of all pairs within `max_difference` s, always the nearest
/// two that are both still free, each image used once. Both lists rise.
pub(super) fn pair_nearest(color: &[Stamp], depth: &[Stamp], max_difference: f64) -> Vec<(usize, usize)> {
    let limit = (max_difference * 1e9).round() as u64;
    let mut near: Vec<(u64, usize, usize)> = Vec::new();
    let mut first = 0;
    for (i, c) in color.iter().enumerate() {
        first += depth[first..].partition_point(|d| d < c && d.nanos.abs_diff(c.nanos) > limit);
        let within = depth[first..].iter().map(|d| d.nanos.abs_diff(c.nanos)).take_while(|&gap| gap <= limit);
        near.extend(within.enumerate().map(|(k, gap)| (gap, i, first + k)));
    }
    near.sort_unstable();
    let (mut color_used, mut depth_used) = (vec![false; color.len()], vec![false; depth.len()]);
    near.retain(|&(_, i, j)| {
        let free = !color_used[i] && !depth_used[j];
        if free {
            (color_used[i], depth_used[j]) = (true, true);
        }
        free
    });
    let mut pairs: Vec<_> = near.into_iter().map(|(_, i, j)| (i, j)).collect();
    pairs.sort_unstable();
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn stamps(millis: &[i64]) -> Vec<Stamp> {
        millis.iter().map(|ms| Stamp::from_nanos(ms * 1_000_000)).collect()
    }

    #[test]
    fn the_nearest_two_go_together_first() {
        let pairs = pair_nearest(&stamps(&[0, 15, 100]), &stamps(&[12, 30, 121]), 0.02);
        assert_eq!(pairs, [(1, 0)]); // 15-12 takes both before 0-12 and 15-30 can; 100-121 is too far
        assert_eq!(pair_nearest(&stamps(&[0, 30]), &stamps(&[20, 50]), 0.02), [(1, 0)]);
        assert_eq!(pair_nearest(&stamps(&[0, 30]), &stamps(&[20, 50]), 0.0), []);
    }

    proptest! {
        #[test]
        fn each_once_within_the_limit_and_none_left(
            a in prop::collection::btree_set(0i64..300, 0..30),
            b in prop::collection::btree_set(0i64..300, 0..30),
        ) {
            let (a, b) = (stamps(&Vec::from_iter(a)), stamps(&Vec::from_iter(b)));
            let pairs = pair_nearest(&a, &b, 0.02);
            prop_assert!(pairs.windows(2).all(|w| w[0].0 < w[1].0));
            let near = |i: usize, j: usize| a[i].nanos.abs_diff(b[j].nanos) <= 20_000_000;
            prop_assert!(pairs.iter().all(|&(i, j)| near(i, j)));
            let mut used: Vec<_> = pairs.iter().map(|p| p.1).collect();
            used.sort_unstable();
            prop_assert!(used.windows(2).all(|w| w[0] < w[1]));
            for i in (0..a.len()).filter(|i| pairs.iter().all(|p| p.0 != *i)) {
                prop_assert!((0..b.len()).all(|j| used.contains(&j) || !near(i, j)));
            }
        }
    }
}

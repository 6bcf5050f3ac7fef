//! The order of a sparse system with a narrow profile.

use std::collections::VecDeque;

/// The row of each node by reverse Cuthill-McKee (Cuthill, McKee 1969; George 1971): breadth first from a node of minimum degree,
/// neighbours by increasing degree, then reversed. Among equals, the lower number comes first. Coupled nodes get near rows.
pub(crate) fn narrow_order(count: usize, pairs: &[(usize, usize)]) -> Vec<usize> {
    let mut neighbours = vec![Vec::new(); count];
    for &(a, b) in pairs.iter().filter(|(a, b)| a != b) {
        neighbours[a].push(b);
        neighbours[b].push(a);
    }
    for own in &mut neighbours {
        own.sort_unstable();
        own.dedup();
    }
    let degree: Vec<usize> = neighbours.iter().map(Vec::len).collect();
    neighbours.iter_mut().for_each(|own| own.sort_by_key(|&n| (degree[n], n)));
    let mut starts: Vec<usize> = (0..count).collect();
    starts.sort_by_key(|&n| (degree[n], n));
    let mut order = Vec::with_capacity(count);
    let mut is_met = vec![false; count];
    for start in starts {
        if std::mem::replace(&mut is_met[start], true) {
            continue;
        }
        let mut queue = VecDeque::from([start]);
        while let Some(node) = queue.pop_front() {
            order.push(node);
            for &next in &neighbours[node] {
                if !std::mem::replace(&mut is_met[next], true) {
                    queue.push_back(next);
                }
            }
        }
    }
    let mut row_of = vec![0; count];
    order.iter().rev().enumerate().for_each(|(row, &node)| row_of[node] = row);
    row_of
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn width(rows: &[usize], pairs: &[(usize, usize)]) -> usize {
        pairs.iter().map(|&(a, b)| rows[a].abs_diff(rows[b])).max().unwrap_or(0)
    }

    proptest! {
        #[test]
        fn every_node_has_its_own_row(count in 1_usize..40, pairs in prop::collection::vec((0_usize..40, 0_usize..40), 0..80)) {
            let pairs: Vec<_> = pairs.into_iter().filter(|&(a, b)| a < count && b < count).collect();
            let mut rows = narrow_order(count, &pairs);
            rows.sort_unstable();
            prop_assert!(rows.into_iter().eq(0..count));
        }

        #[test]
        fn a_chain_of_any_numbering_has_neighbouring_rows(shuffled in Just((0..30_usize).collect::<Vec<_>>()).prop_shuffle()) {
            let chain: Vec<_> = shuffled.windows(2).map(|pair| (pair[0], pair[1])).collect();
            prop_assert_eq!(width(&narrow_order(30, &chain), &chain), 1);
        }
    }

    #[test]
    fn the_direction_and_the_repetition_of_pairs_do_not_matter() {
        let pairs = [(0, 3), (3, 1), (1, 4), (4, 2), (2, 0)];
        let doubled: Vec<_> = pairs.iter().flat_map(|&(a, b)| [(b, a), (a, b), (a, a)]).collect();
        assert_eq!(narrow_order(5, &pairs), narrow_order(5, &doubled));
        assert_eq!(width(&narrow_order(5, &pairs), &pairs), 2);
    }
}

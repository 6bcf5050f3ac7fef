//! The order of a sparse system that keeps its profile narrow.

use std::collections::VecDeque;

/// The row of each node by reverse Cuthill-McKee (Cuthill, McKee 1969; George 1971): breadth first from a node of least
/// degree, neighbours by rising degree, then backwards. Ties go to the lower number. Keeps coupled nodes near each other.
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

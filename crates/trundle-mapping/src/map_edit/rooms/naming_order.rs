//! The order in which rooms are counted.

use super::room::Room;

/// The indices of rooms as one reads: rows from the top, each from the left. A room belongs to a row if its centre is above the lower end
/// of the row's first room.
pub(super) fn reading_order(rooms: &[&Room]) -> Vec<usize> {
    let low = |i: usize| rooms[i].rings.iter().flatten().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let mut left: Vec<usize> = (0..rooms.len()).collect();
    left.sort_by(|a, b| rooms[*b].center.y.total_cmp(&rooms[*a].center.y).then(a.cmp(b)));
    let mut order = Vec::new();
    while let Some(first) = left.first() {
        let end = low(*first);
        let (mut row, rest): (Vec<usize>, Vec<usize>) = left.iter().partition(|i| rooms[**i].center.y > end);
        row.sort_by(|a, b| rooms[*a].center.x.total_cmp(&rooms[*b].center.x).then(a.cmp(b)));
        order.append(&mut row);
        left = rest;
    }
    order
}

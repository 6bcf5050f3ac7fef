//! Leaves out points that no hull can touch first.
//!
//! Where a convex hull touches a point, it holds a sector there that is as wide as its sharpest corner. At the first contact
//! of a motion no point is inside; so a point that has others all around it, with no gap as wide as that corner, is never
//! touched first, and need not be kept. Exact, and it takes the inside out of thick clouds.

use crate::geometry::Hull;
use trundle_core::Vector2;

/// Fewer points than this are kept as they are.
const FEW: usize = 2000;
/// Side of the cells in which neighbours are sought, m: none is farther than 1.2 cm, which a blunt hull holds.
const CELL: f64 = 0.004;

/// The points that matter to `hull`.
pub fn thin(points: Vec<(Vector2, u32)>, hull: &Hull) -> Vec<(Vector2, u32)> {
    if points.len() < FEW || !hull.is_blunt() {
        return points;
    }
    let key = |p: &Vector2| ((p.x / CELL).floor() as i64, (p.y / CELL).floor() as i64);
    let mut sorted: Vec<((i64, i64), Vector2, u32)> =
        points.into_iter().map(|(p, n)| (key(&p), p, n)).collect();
    sorted.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.2.cmp(&b.2)));
    let strip = |column: i64, row: i64| {
        let from = sorted.partition_point(|(key, ..)| *key < (column, row - 1));
        let to = from + sorted[from..].partition_point(|(key, ..)| *key <= (column, row + 1));
        from..to
    };
    let mut strips = [0..0, 0..0, 0..0];
    let mut cell = (i64::MIN, i64::MIN);
    let mut kept = Vec::new();
    for &(key, p, number) in &sorted {
        if key != cell {
            cell = key;
            strips = [-1, 0, 1].map(|side| strip(key.0 + side, key.1));
        }
        let neighbours = strips.iter().flat_map(|range| &sorted[range.clone()]).map(|(_, q, _)| q - p);
        if !is_surrounded(neighbours) {
            kept.push((p, number));
        }
    }
    kept
}

/// Whether each of the eight octants holds a neighbour: then no gap is as wide as a right angle.
fn is_surrounded(neighbours: impl Iterator<Item = Vector2>) -> bool {
    let mut octants = 0_u8;
    for d in neighbours.filter(|d| d.x != 0.0 || d.y != 0.0) {
        octants |=
            1 << (u8::from(d.x > 0.0) | u8::from(d.y > 0.0) << 1 | u8::from(d.x.abs() > d.y.abs()) << 2);
        if octants == u8::MAX {
            return true;
        }
    }
    false
}

//! The outline of cells as polygons.

use std::collections::{BTreeMap, BTreeSet};
use trundle_core::{GridGeometry, Vector2};

/// Corner of cells: column, row.
type Corner = (i64, i64);

/// Steps along the sides of cells: right, up, left, down.
const SIDE_STEPS: [Corner; 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// The rings about cells that are connected by sides: the outer one first, counter-clockwise, then holes, clockwise. Only corners at which
/// a ring turns; the first is not repeated.
pub(super) fn outline(geometry: &GridGeometry, cells: &[usize]) -> Vec<Vec<Vector2>> {
    let members: BTreeSet<Corner> =
        cells.iter().map(|i| geometry.cell(*i)).map(|cell| (cell.col as i64, cell.row as i64)).collect();
    let mut sides = sides(&members);
    let mut rings: Vec<Vec<Corner>> = Vec::new();
    while let Some(start) = sides.first_key_value().map(|(corner, _)| *corner) {
        rings.push(ring(&mut sides, start));
    }
    rings.sort_by_key(|ring| std::cmp::Reverse(double_area(ring)));
    let point =
        |(col, row): &Corner| geometry.origin + Vector2::new(*col as f64, *row as f64) * geometry.resolution;
    rings.iter().map(|ring| ring.iter().map(point).collect()).collect()
}

/// The sides between members and others as steps from corner to corner, the members on the left.
fn sides(members: &BTreeSet<Corner>) -> BTreeMap<Corner, Vec<usize>> {
    let mut sides: BTreeMap<Corner, Vec<usize>> = BTreeMap::new();
    for &(col, row) in members {
        // Below, right, above, left of the member, counter-clockwise about it.
        let around = [
            ((col, row - 1), (col, row)),
            ((col + 1, row), (col + 1, row)),
            ((col, row + 1), (col + 1, row + 1)),
            ((col - 1, row), (col, row + 1)),
        ];
        for (step, (other, corner)) in around.into_iter().enumerate() {
            if !members.contains(&other) {
                sides.entry(corner).or_default().push(step);
            }
        }
    }
    sides
}

/// Takes a ring out of the sides. Where two cells touch at a corner, the ring stays with its cell.
fn ring(sides: &mut BTreeMap<Corner, Vec<usize>>, start: Corner) -> Vec<Corner> {
    let mut ring = Vec::new();
    let (mut at, mut last) = (start, None);
    while let Some(open) = sides.get_mut(&at) {
        let turn = |step: &usize| last.map_or(0, |last: usize| (last + 1 + 4 - step) % 4);
        let Some((index, _)) = open.iter().enumerate().min_by_key(|(_, step)| turn(step)) else { break };
        let step = open.swap_remove(index);
        if open.is_empty() {
            sides.remove(&at);
        }
        if last != Some(step) {
            ring.push(at);
        }
        at = (at.0 + SIDE_STEPS[step].0, at.1 + SIDE_STEPS[step].1);
        last = Some(step);
    }
    // The start is a corner only if the ring turns there.
    let is_straight = ring.len() > 2 && on_line(ring[ring.len() - 1], ring[0], ring[1]);
    if is_straight {
        ring.remove(0);
    }
    ring
}

fn on_line(a: Corner, b: Corner, c: Corner) -> bool {
    (a.0 == b.0 && b.0 == c.0) || (a.1 == b.1 && b.1 == c.1)
}

/// Twice the area of a ring, negative for a hole.
fn double_area(ring: &[Corner]) -> i64 {
    let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
    pairs.map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Cell, OccupancyGrid};

    fn rings(art: &str) -> Vec<Vec<(i64, i64)>> {
        let grid = OccupancyGrid::from_ascii(1.0, art).unwrap();
        let cells: Vec<usize> =
            (0..grid.geometry().len()).filter(|i| grid.cells()[*i] == Cell::Free).collect();
        let whole = |p: &Vector2| (p.x as i64, p.y as i64);
        outline(grid.geometry(), &cells).iter().map(|ring| ring.iter().map(whole).collect()).collect()
    }

    #[test]
    fn a_ring_has_the_corners_of_its_cells() {
        assert_eq!(rings("..."), [vec![(0, 0), (3, 0), (3, 1), (0, 1)]]);
        assert_eq!(rings(".#\n.."), [vec![(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]]);
    }

    #[test]
    fn holes_run_clockwise_and_touching_corners_stay_apart() {
        let found = rings("...\n.#.\n...");
        assert_eq!(found[0], [(0, 0), (3, 0), (3, 3), (0, 3)]);
        assert_eq!((found.len(), found[1].len(), double_area(&found[1])), (2, 4, -2));
        let pinched = rings("....\n.##.\n.#..\n...#");
        let areas: Vec<i64> = pinched.iter().map(|ring| double_area(ring) / 2).collect();
        assert_eq!(areas.iter().sum::<i64>(), 12);
    }
}

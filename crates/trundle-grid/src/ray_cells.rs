//! Exact traversal of the cells along a straight line.

use crate::GridCell;
use trundle_core::Vector2;

/// Iterator over the cells on the straight line from `from` to `to` (in cells): in order, first and last included, each once.
///
/// Exact traversal (Amanatides and Woo, A fast voxel traversal algorithm, 1987). A line through a corner steps along x first.
/// Cost: one comparison a cell. The coordinates must be finite and within 2^30 cells.
pub fn ray_cells(from: Vector2, to: Vector2) -> RayCells {
    let (start, end) = (GridCell::containing(from), GridCell::containing(to));
    let direction = to - from;
    RayCells {
        next: Some(start),
        x: Axis::new(from.x, direction.x, start.x, end.x),
        y: Axis::new(from.y, direction.y, start.y, end.y),
    }
}

/// Iterator of [`ray_cells`].
#[derive(Debug, Clone)]
pub struct RayCells {
    next: Option<GridCell>,
    x: Axis,
    y: Axis,
}

/// One axis of the traversal: position and spacing of the cell borders along the line.
#[derive(Debug, Clone)]
struct Axis {
    step: i32,
    remaining: u32,
    /// Fraction of the line at the next border (t_max in the paper).
    next_border: f64,
    /// Fraction of the line between two borders (t_delta in the paper).
    between_borders: f64,
}

impl Axis {
    fn new(from: f64, direction: f64, start: i32, end: i32) -> Self {
        let border = f64::from(start) + if direction > 0.0 { 1.0 } else { 0.0 };
        let remaining = end.abs_diff(start);
        Self {
            step: (end - start).signum(),
            remaining,
            next_border: if remaining > 0 { (border - from) / direction } else { f64::INFINITY },
            between_borders: if remaining > 0 { 1.0 / direction.abs() } else { f64::INFINITY },
        }
    }

    fn advance(&mut self) -> i32 {
        self.remaining -= 1;
        self.next_border =
            if self.remaining > 0 { self.next_border + self.between_borders } else { f64::INFINITY };
        self.step
    }
}

impl Iterator for RayCells {
    type Item = GridCell;

    fn next(&mut self) -> Option<GridCell> {
        let here = self.next?;
        self.next = if self.x.remaining == 0 && self.y.remaining == 0 {
            None
        } else if self.x.next_border <= self.y.next_border {
            Some(GridCell { x: here.x + self.x.advance(), y: here.y })
        } else {
            Some(GridCell { x: here.x, y: here.y + self.y.advance() })
        };
        Some(here)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cells(from: (f64, f64), to: (f64, f64)) -> Vec<(i32, i32)> {
        ray_cells(Vector2::new(from.0, from.1), Vector2::new(to.0, to.1)).map(|c| (c.x, c.y)).collect()
    }

    #[test]
    fn straight_lines_and_a_point() {
        assert_eq!(cells((0.5, 0.5), (3.5, 0.5)), [(0, 0), (1, 0), (2, 0), (3, 0)]);
        assert_eq!(cells((0.5, 0.5), (0.5, -1.5)), [(0, 0), (0, -1), (0, -2)]);
        assert_eq!(cells((0.2, 0.2), (0.8, 0.3)), [(0, 0)]);
        assert_eq!(cells((0.5, 0.5), (2.5, 2.5)), [(0, 0), (1, 0), (1, 1), (2, 1), (2, 2)]);
    }

    /// Length of the line inside a cell, by clipping: independent of the traversal.
    fn length_inside(from: Vector2, to: Vector2, cell: GridCell) -> f64 {
        let (mut enter, mut exit) = (0.0_f64, 1.0_f64);
        for (p, d, low) in
            [(from.x, to.x - from.x, f64::from(cell.x)), (from.y, to.y - from.y, f64::from(cell.y))]
        {
            let (a, b) = ((low - p) / d, (low + 1.0 - p) / d);
            enter = enter.max(a.min(b));
            exit = exit.min(a.max(b));
        }
        (exit - enter).max(0.0) * (to - from).norm()
    }

    proptest! {
        #[test]
        fn visits_exactly_the_cells_on_the_line(
            x in -20.0..20.0, y in -20.0..20.0, u in -20.0..20.0, v in -20.0..20.0,
        ) {
            let (from, to) = (Vector2::new(x, y), Vector2::new(u, v));
            let found: Vec<GridCell> = ray_cells(from, to).collect();
            for cx in -21..21 {
                for cy in -21..21 {
                    let cell = GridCell { x: cx, y: cy };
                    let visits = found.iter().filter(|&&c| c == cell).count();
                    let length = length_inside(from, to, cell);
                    prop_assert!(visits <= 1);
                    prop_assert!(visits == 1 || length < 1e-9, "{cell:?} missed, {length} inside");
                    prop_assert!(visits == 0 || length > 0.0 || found.len() == 1 || length > -1e-9);
                }
            }
            prop_assert!((found.len() as i32 - 1) == (to.x.floor() - from.x.floor()).abs() as i32
                + (to.y.floor() - from.y.floor()).abs() as i32);
        }

        #[test]
        fn successive_cells_share_an_edge_and_the_ends_are_those_of_the_line(
            x in -300.0..300.0, y in -300.0..300.0, u in -300.0..300.0, v in -300.0..300.0,
        ) {
            let (from, to) = (Vector2::new(x, y), Vector2::new(u, v));
            let found: Vec<GridCell> = ray_cells(from, to).collect();
            prop_assert_eq!(found[0], GridCell::containing(from));
            prop_assert_eq!(found[found.len() - 1], GridCell::containing(to));
            for pair in found.windows(2) {
                prop_assert_eq!((pair[0].x - pair[1].x).abs() + (pair[0].y - pair[1].y).abs(), 1);
            }
        }
    }
}

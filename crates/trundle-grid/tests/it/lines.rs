//! Laws of the traversal of cells along a line.

use proptest::prelude::*;
use std::collections::BTreeSet;
use trundle_core::Vector2;
use trundle_grid::{GridCell, ray_cells};

fn any_point() -> impl Strategy<Value = Vector2> {
    (-60.0..60.0_f64, -60.0..60.0_f64).prop_map(|(x, y)| Vector2::new(x, y))
}

fn cells(from: Vector2, to: Vector2) -> BTreeSet<GridCell> {
    ray_cells(from, to).collect()
}

proptest! {
    #[test]
    fn the_line_back_passes_the_same_cells(a in any_point(), b in any_point()) {
        prop_assert_eq!(cells(a, b), cells(b, a));
    }

    #[test]
    fn a_shift_by_whole_cells_shifts_the_cells(a in any_point(), b in any_point(), dx in -99..99_i32, dy in -99..99_i32) {
        let shift = Vector2::new(f64::from(dx), f64::from(dy));
        let moved: BTreeSet<_> = cells(a, b).iter().map(|c| GridCell { x: c.x + dx, y: c.y + dy }).collect();
        let there = cells(a + shift, b + shift);
        // A corner within rounding of the line may be passed on either side.
        prop_assert!(moved.symmetric_difference(&there).count() <= 2, "{:?}", moved.symmetric_difference(&there).collect::<Vec<_>>());
    }

    #[test]
    fn the_line_mirrored_at_the_diagonal_passes_the_mirrored_cells(a in any_point(), b in any_point()) {
        let flip = |p: Vector2| Vector2::new(p.y, p.x);
        let mirrored: BTreeSet<_> = cells(a, b).iter().map(|c| GridCell { x: c.y, y: c.x }).collect();
        prop_assert_eq!(cells(flip(a), flip(b)), mirrored);
    }

    #[test]
    fn a_part_of_a_line_passes_a_part_of_its_cells(a in any_point(), b in any_point(), part in 0.0..1.0_f64) {
        let (whole, begin) = (cells(a, b), cells(a, a + (b - a) * part));
        prop_assert!(begin.difference(&whole).count() <= 1);
        prop_assert!(begin.len() <= whole.len() + 1);
    }

    #[test]
    fn a_point_lies_in_its_cell(p in any_point()) {
        let off = p - GridCell::containing(p).center_cells();
        prop_assert!(off.amax() <= 0.5 && off.x < 0.5 && off.y < 0.5);
        prop_assert_eq!(cells(p, p).len(), 1);
    }
}

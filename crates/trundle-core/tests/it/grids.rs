//! Laws of grid geometry and occupancy grids.

use proptest::prelude::*;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};

fn any_geometry() -> impl Strategy<Value = GridGeometry> {
    (0.005..0.5_f64, -200.0..200.0_f64, -200.0..200.0_f64, 1_usize..90, 1_usize..90)
        .prop_map(|(resolution, x, y, w, h)| GridGeometry::new(resolution, Vector2::new(x, y), w, h).unwrap())
}

proptest! {
    #[test]
    fn the_centre_of_a_cell_lies_in_that_cell(geometry in any_geometry(), i in 0.0..1.0_f64) {
        let cell = geometry.cell((i * geometry.len() as f64) as usize);
        prop_assert_eq!(geometry.cell_at(geometry.center(cell)), Some(cell));
    }

    #[test]
    fn storage_places_and_cells_invert_each_other(geometry in any_geometry(), i in 0.0..1.0_f64) {
        let linear = (i * geometry.len() as f64) as usize;
        let cell = geometry.cell(linear);
        prop_assert_eq!(geometry.linear(cell), linear);
        prop_assert!(cell.col < geometry.width && cell.row < geometry.height);
    }

    #[test]
    fn a_point_is_at_most_half_a_cell_from_the_centre_of_its_cell(geometry in any_geometry(), u in 0.0..1.0_f64, v in 0.0..1.0_f64) {
        let size = Vector2::new(geometry.width as f64, geometry.height as f64) * geometry.resolution;
        let point = geometry.origin + size.component_mul(&Vector2::new(u, v));
        if let Some(cell) = geometry.cell_at(point) {
            prop_assert!((geometry.center(cell) - point).amax() <= geometry.resolution * (0.5 + 1e-9));
        } else {
            prop_assert!(u > 1.0 - 1e-9 || v > 1.0 - 1e-9, "{} {}", u, v);
        }
    }

    #[test]
    fn a_point_outside_the_rectangle_has_no_cell(geometry in any_geometry(), far in 1e-6..100.0_f64, along in 0.0..1.0_f64) {
        let size = Vector2::new(geometry.width as f64, geometry.height as f64) * geometry.resolution;
        let (low, high) = (geometry.origin, geometry.origin + size);
        let middle = low + size * along;
        for point in [
            Vector2::new(low.x - far, middle.y), Vector2::new(high.x + far, middle.y),
            Vector2::new(middle.x, low.y - far), Vector2::new(middle.x, high.y + far),
        ] {
            prop_assert_eq!(geometry.cell_at(point), None);
        }
    }
}

#[test]
fn a_cell_holds_its_lower_left_edges_and_not_its_upper_right_ones() {
    let geometry = GridGeometry::new(0.5, Vector2::new(-1.0, -1.0), 4, 2).unwrap();
    let at = |x: f64, y: f64| geometry.cell_at(Vector2::new(x, y)).map(|cell| (cell.col, cell.row));
    assert_eq!(at(-1.0, -1.0), Some((0, 0)));
    assert_eq!(at(-0.5, -1.0), Some((1, 0)));
    assert_eq!(at(-0.5 - 1e-12, -0.5), Some((0, 1)));
    assert_eq!((at(1.0, -1.0), at(-1.0, 0.0)), (None, None));
    assert_eq!(at(1.0 - 1e-12, -1e-12), Some((3, 1)));
}

#[test]
fn negative_coordinates_are_rounded_down_and_not_to_zero() {
    let geometry = GridGeometry::new(1.0, Vector2::zeros(), 3, 3).unwrap();
    for point in [(-0.3, 0.5), (0.5, -0.3), (-1e-9, -1e-9)] {
        assert_eq!(geometry.cell_at(Vector2::new(point.0, point.1)), None, "{point:?}");
    }
}

#[test]
fn points_that_are_not_finite_have_no_cell_and_are_unknown() {
    let grid = OccupancyGrid::from_ascii(1.0, "##\n##").unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for point in [Vector2::new(bad, 0.5), Vector2::new(0.5, bad)] {
            assert_eq!(grid.geometry().cell_at(point), None);
            assert_eq!(grid.at(point), Cell::Unknown);
        }
    }
}

#[test]
fn setting_a_cell_changes_that_cell_alone() {
    let geometry = GridGeometry::new(0.1, Vector2::new(3.0, -3.0), 5, 4).unwrap();
    for linear in 0..geometry.len() {
        let mut grid = OccupancyGrid::filled(geometry, Cell::Unknown);
        grid.set(geometry.cell(linear), Cell::Occupied);
        assert_eq!(grid.get(geometry.cell(linear)), Cell::Occupied);
        assert_eq!(grid.at(geometry.center(geometry.cell(linear))), Cell::Occupied);
        assert_eq!(grid.cells().iter().filter(|cell| **cell != Cell::Unknown).count(), 1);
        assert_eq!(grid.cells()[linear], Cell::Occupied);
    }
}

#[test]
fn rows_are_stored_from_the_lowest_y() {
    let grid = OccupancyGrid::from_ascii(1.0, "..#\n#??").unwrap();
    use Cell::{Free, Occupied, Unknown};
    assert_eq!(grid.cells(), [Occupied, Unknown, Unknown, Free, Free, Occupied]);
    assert_eq!(grid.geometry().cell(4), CellIndex { col: 1, row: 1 });
}

#[test]
#[should_panic(expected = "outside")]
fn a_cell_outside_is_a_panic_and_not_another_cell() {
    let grid = OccupancyGrid::from_ascii(1.0, "..\n..").unwrap();
    grid.get(CellIndex { col: 2, row: 0 });
}

//! The distance field against brute force.

use super::*;
use proptest::prelude::*;

fn brute_force(grid: &OccupancyGrid, unknown: UnknownIs, point: Vector2) -> f64 {
    let geometry = grid.geometry();
    let mut best = NO_OBSTACLE_DISTANCE_M;
    for (i, cell) in grid.cells().iter().enumerate() {
        if *cell == Cell::Occupied || (*cell == Cell::Unknown && unknown == UnknownIs::Obstacle) {
            let off = (point - geometry.center(geometry.cell(i))).abs();
            let gap = off.map(|d| (d - geometry.resolution / 2.0).max(0.0));
            best = best.min(gap.norm());
        }
    }
    if unknown == UnknownIs::Obstacle {
        let p = (point - geometry.origin) / geometry.resolution;
        let (w, h) = (geometry.width as f64, geometry.height as f64);
        let border = p.x.min(p.y).min(w - p.x).min(h - p.y).max(0.0);
        best = best.min(border * geometry.resolution);
    }
    best
}

prop_compose! {
    fn any_grid()(w in 1usize..17, h in 1usize..17)
        (w in Just(w), h in Just(h), cells in prop::collection::vec(0u8..12, w * h)) -> OccupancyGrid {
        let geometry = GridGeometry::new(0.1, Vector2::new(-0.3, 0.7), w, h).unwrap();
        let cell = |c: u8| match c { 0 => Cell::Occupied, 1 => Cell::Unknown, _ => Cell::Free };
        OccupancyGrid::new(geometry, cells.into_iter().map(cell).collect()).unwrap()
    }
}

proptest! {
    #[test]
    fn centres_agree_with_brute_force(grid in any_grid(), obstacle in any::<bool>()) {
        let unknown = if obstacle { UnknownIs::Obstacle } else { UnknownIs::Free };
        let field = DistanceField::from_grid(&grid, unknown);
        for i in 0..grid.geometry().len() {
            let cell = grid.geometry().cell(i);
            let truth = brute_force(&grid, unknown, grid.geometry().center(cell));
            prop_assert!((field.at_cell(cell) - truth).abs() <= 1e-6 * truth.max(1.0));
        }
    }

    #[test]
    fn an_update_is_what_a_new_field_would_be(
        grid in any_grid(), obstacle in any::<bool>(), reach in prop::sample::select(vec![0.0, 0.45, 0.8, NO_OBSTACLE_DISTANCE_M]),
        changes in prop::collection::vec((0usize..17, 0usize..17, 0u8..3), 1..9),
    ) {
        let unknown = if obstacle { UnknownIs::Obstacle } else { UnknownIs::Free };
        let mut field = DistanceField::up_to(reach, &grid, unknown);
        let mut grid = grid;
        for part in changes.chunks(3) {
            for (col, row, value) in part {
                let cell = CellIndex { col: col % grid.geometry().width, row: row % grid.geometry().height };
                grid.set(cell, [Cell::Occupied, Cell::Unknown, Cell::Free][usize::from(*value)]);
            }
            field.update(&grid);
            prop_assert_eq!(&field, &DistanceField::up_to(reach, &grid, unknown));
        }
    }

    #[test]
    fn what_is_told_apart_is_exact(grid in any_grid(), reach in 0.4..2.0, x in -0.3..1.3, y in 0.7..2.3) {
        let whole = DistanceField::from_grid(&grid, UnknownIs::Free);
        let field = DistanceField::up_to(reach, &grid, UnknownIs::Free);
        for i in 0..grid.geometry().len() {
            let cell = grid.geometry().cell(i);
            prop_assert_eq!(field.at_cell(cell), f64::from(whole.at_cell(cell).min(reach) as f32));
        }
        let point = Vector2::new(x, y);
        let truth = brute_force(&grid, UnknownIs::Free, point).min(5.0).min(reach);
        prop_assert!((field.clearance(point, 5.0) - truth).abs() < 1e-6);
    }

    /// Rows longer than a block.
    #[test]
    fn long_rows_agree_with_brute_force(
        w in 60usize..140, h in 1usize..9, obstacle in any::<bool>(),
        marks in prop::collection::vec((0usize..140, 0usize..9), 1..12),
    ) {
        let unknown = if obstacle { UnknownIs::Obstacle } else { UnknownIs::Free };
        let geometry = GridGeometry::new(0.1, Vector2::new(-0.3, 0.7), w, h).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        marks.iter().for_each(|(c, r)| grid.set(CellIndex { col: c % w, row: r % h }, Cell::Occupied));
        let field = DistanceField::from_grid(&grid, unknown);
        for i in 0..geometry.len() {
            let truth = brute_force(&grid, unknown, geometry.center(geometry.cell(i)));
            prop_assert!((field.at_linear(i) - truth).abs() <= 1e-6 * truth.max(1.0));
        }
    }

    #[test]
    fn clearance_is_exact_anywhere(grid in any_grid(), x in -0.3..1.3, y in 0.7..2.3) {
        let field = DistanceField::from_grid(&grid, UnknownIs::Free);
        let point = Vector2::new(x, y);
        let truth = brute_force(&grid, UnknownIs::Free, point).min(0.5);
        prop_assert!((field.clearance(point, 0.5) - truth).abs() < 1e-9);
    }

    #[test]
    fn gradient_agrees_with_differences(grid in any_grid(), x in -0.5..1.5, y in 0.5..2.5, obstacle in any::<bool>()) {
        let unknown = if obstacle { UnknownIs::Obstacle } else { UnknownIs::Free };
        let field = DistanceField::from_grid(&grid, unknown);
        let at = |dx: f64, dy: f64| field.distance(Vector2::new(x + dx, y + dy));
        prop_assume!(at(0.0, 0.0) < NO_OBSTACLE_DISTANCE_M / 2.0);
        let h = 1e-6;
        let numeric = Vector2::new(at(h, 0.0) - at(-h, 0.0), at(0.0, h) - at(0.0, -h)) / (2.0 * h);
        let kink = |p: f64, o: f64| (((p - o) / 0.1 - 0.5).rem_euclid(1.0) - 0.5).abs() > 0.5 - 1e-3;
        prop_assume!(!kink(x, -0.3) && !kink(y, 0.7) && (!obstacle || at(0.0, 0.0) > 1e-3));
        prop_assert!((numeric - field.gradient(Vector2::new(x, y))).norm() < 1e-4);
    }
}

#[test]
fn nowhere_and_outside_follow_the_policy() {
    let grid = OccupancyGrid::from_ascii(0.5, "....\n....").unwrap();
    let free = DistanceField::from_grid(&grid, UnknownIs::Free);
    let walled = DistanceField::from_grid(&grid, UnknownIs::Obstacle);
    assert_eq!(free.distance(Vector2::new(9.0, 9.0)), NO_OBSTACLE_DISTANCE_M);
    assert_eq!(walled.distance(Vector2::new(9.0, 9.0)), 0.0);
    assert_eq!(free.distance(Vector2::new(f64::NAN, 0.0)), 0.0);
    assert!((walled.distance(Vector2::new(1.0, 0.2)) - 0.2).abs() < 1e-6);
}

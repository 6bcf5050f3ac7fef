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
    fn distances_within_reach_are_exact(grid in any_grid(), reach in 0.4..2.0, x in -0.3..1.3, y in 0.7..2.3) {
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

proptest! {
    /// Distances of two cells differ at most by the distance between the cells.
    #[test]
    fn distances_of_cells_differ_by_no_more_than_the_cells_are_apart(
        grid in any_grid(), obstacle in any::<bool>(), a: prop::sample::Index, b: prop::sample::Index,
    ) {
        let unknown = if obstacle { UnknownIs::Obstacle } else { UnknownIs::Free };
        let field = DistanceField::from_grid(&grid, unknown);
        let cell = |index: prop::sample::Index| grid.geometry().cell(index.index(grid.geometry().len()));
        let (a, b) = (cell(a), cell(b));
        let apart = (grid.geometry().center(a) - grid.geometry().center(b)).norm();
        let (x, y) = (field.at_cell(a), field.at_cell(b));
        prop_assume!(x < NO_OBSTACLE_DISTANCE_M / 2.0);
        prop_assert!((x - y).abs() <= apart + 1e-5, "{x} m and {y} m, {apart} m apart");
    }

    /// A further obstacle makes no distance longer, and its own cell gets distance 0.
    #[test]
    fn a_further_obstacle_makes_no_distance_longer(grid in any_grid(), at: prop::sample::Index) {
        let before = DistanceField::from_grid(&grid, UnknownIs::Free);
        let mut more = grid;
        let cell = more.geometry().cell(at.index(more.geometry().len()));
        more.set(cell, Cell::Occupied);
        let after = DistanceField::from_grid(&more, UnknownIs::Free);
        prop_assert_eq!(after.at_cell(cell), 0.0);
        for i in 0..more.geometry().len() {
            prop_assert!(after.at_linear(i) <= before.at_linear(i));
        }
    }

    /// Unknown cells as obstacles make no distance longer than unknown cells as free floor.
    #[test]
    fn unknown_cells_as_obstacles_shorten_distances(grid in any_grid(), x in -0.3..1.3, y in 0.7..2.3) {
        let free = DistanceField::from_grid(&grid, UnknownIs::Free);
        let walled = DistanceField::from_grid(&grid, UnknownIs::Obstacle);
        for i in 0..grid.geometry().len() {
            prop_assert!(walled.at_linear(i) <= free.at_linear(i));
        }
        let point = Vector2::new(x, y);
        prop_assert!(walled.clearance(point, 0.5) <= free.clearance(point, 0.5) + 1e-9);
        prop_assert!(walled.is_walled() && !free.is_walled());
        prop_assert!(free.border_gap(point).is_infinite());
    }

    /// A disc is clear exactly if its radius is at most the clearance.
    #[test]
    fn a_disc_keeps_clear_exactly_when_its_clearance_reaches_its_radius(
        grid in any_grid(), x in -0.3..1.3, y in 0.7..2.3, radius in 0.02..0.6_f64,
    ) {
        let field = DistanceField::from_grid(&grid, UnknownIs::Obstacle);
        let point = Vector2::new(x, y);
        let clearance = field.clearance(point, 1.0);
        prop_assume!((clearance - radius).abs() > 1e-5);
        prop_assert_eq!(field.has_clearance(point, radius), clearance > radius, "{} m", clearance);
    }

    /// Interpolated distances are at most the documented excess above the truth.
    #[test]
    fn an_interpolated_distance_exceeds_the_truth_by_no_more_than_its_bound(
        grid in any_grid(), x in -0.2..1.2, y in 0.8..2.2,
    ) {
        let field = DistanceField::from_grid(&grid, UnknownIs::Free);
        let point = Vector2::new(x, y);
        prop_assume!(grid.geometry().cell_at(point).is_some());
        let truth = brute_force(&grid, UnknownIs::Free, point);
        prop_assume!(truth < 100.0);
        prop_assert!(field.distance(point) <= truth + field.overestimate(truth) + 1e-6);
    }

    /// The maximum of a block equals the largest distance of its cells.
    #[test]
    fn the_maximum_of_a_block_is_that_of_its_cells(grid in any_grid(), obstacle in any::<bool>()) {
        let unknown = if obstacle { UnknownIs::Obstacle } else { UnknownIs::Free };
        let field = DistanceField::from_grid(&grid, unknown);
        let BlockMaxima { width, height, distance } = field.blocks();
        let mut expected = vec![0.0_f64; width * height];
        for i in 0..grid.geometry().len() {
            let cell = grid.geometry().cell(i);
            let block = cell.row / BLOCK_SIDE_CELLS * width + cell.col / BLOCK_SIDE_CELLS;
            expected[block] = expected[block].max(field.at_linear(i));
        }
        prop_assert!(distance.iter().zip(&expected).all(|(found, expected)| f64::from(*found) == *expected));
    }

    /// Boundary cells are the obstacle cells of the box that have a free neighbour.
    #[test]
    fn rims_are_obstacles_with_a_free_neighbour(grid in any_grid()) {
        let field = DistanceField::from_grid(&grid, UnknownIs::Free);
        let (low, high) = field.extent();
        let mut found = Vec::new();
        field.for_obstacle_rims_in(low, high, |center| found.push(grid.geometry().cell_at(center)));
        let is_obstacle = |col: i64, row: i64| field.blocks_at(col, row);
        let (width, height) = (grid.geometry().width as i64, grid.geometry().height as i64);
        let mut expected = Vec::new();
        for (row, col) in (0..height).flat_map(|row| (0..width).map(move |col| (row, col))) {
            let sides = [(col - 1, row), (col + 1, row), (col, row - 1), (col, row + 1)];
            let inside = |(c, r): &(i64, i64)| (0..width).contains(c) && (0..height).contains(r);
            let free = sides.iter().filter(|side| inside(side)).any(|(c, r)| !is_obstacle(*c, *r));
            if is_obstacle(col, row) && free {
                expected.push(Some(CellIndex { col: col as usize, row: row as usize }));
            }
        }
        prop_assert_eq!(found, expected);
    }
}

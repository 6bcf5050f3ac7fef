//! Laws of the distance field, of the potential on it, and of moving obstacles.

use proptest::prelude::*;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};
use trundle_planning::{
    DistanceField, MovingObstacle, NO_OBSTACLE_DISTANCE_M, PotentialConfig, PotentialField, UnknownIs,
};

const SIDE: usize = 24;
const RESOLUTION: f64 = 0.1;

fn grid(occupied: &[(usize, usize)]) -> OccupancyGrid {
    let geometry = GridGeometry::new(RESOLUTION, Vector2::new(-0.7, 0.4), SIDE, SIDE).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    occupied.iter().for_each(|&(col, row)| grid.set(CellIndex { col, row }, Cell::Occupied));
    grid
}

fn field(occupied: &[(usize, usize)]) -> DistanceField {
    DistanceField::from_grid(&grid(occupied), UnknownIs::Free)
}

fn any_cells() -> impl Strategy<Value = Vec<(usize, usize)>> {
    prop::collection::vec((0..SIDE, 0..SIDE), 1..20)
}

fn any_point() -> impl Strategy<Value = Vector2> {
    (-0.6..1.6_f64, 0.5..2.7_f64).prop_map(|(x, y)| Vector2::new(x, y))
}

proptest! {
    #[test]
    fn one_more_obstacle_increases_no_distance(cells in any_cells(), more in (0..SIDE, 0..SIDE)) {
        let (before, after) = (field(&cells), field(&[&cells[..], &[more]].concat()));
        for linear in 0..SIDE * SIDE {
            let cell = before.geometry().cell(linear);
            prop_assert!(after.at_cell(cell) <= before.at_cell(cell));
        }
    }

    #[test]
    fn neighbouring_cells_differ_by_at_most_a_side(cells in any_cells()) {
        let field = field(&cells);
        for (col, row) in (0..SIDE - 1).flat_map(|col| (0..SIDE).map(move |row| (col, row))) {
            let at = |col: usize, row: usize| field.at_cell(CellIndex { col, row });
            prop_assert!((at(col, row) - at(col + 1, row)).abs() <= RESOLUTION + 1e-6);
            prop_assert!((at(row, col) - at(row, col + 1)).abs() <= RESOLUTION + 1e-6);
        }
    }

    #[test]
    fn the_mirrored_map_has_the_mirrored_field(cells in any_cells()) {
        let flipped: Vec<_> = cells.iter().map(|&(col, row)| (SIDE - 1 - col, row)).collect();
        let (one, other) = (field(&cells), field(&flipped));
        for (col, row) in (0..SIDE).flat_map(|col| (0..SIDE).map(move |row| (col, row))) {
            let mirrored = other.at_cell(CellIndex { col: SIDE - 1 - col, row });
            prop_assert_eq!(one.at_cell(CellIndex { col, row }), mirrored);
        }
    }

    #[test]
    fn a_limited_field_is_the_whole_field_cut_at_its_reach(cells in any_cells(), reach in 0.4..2.0_f64) {
        let (whole, limited) = (field(&cells), DistanceField::up_to(reach, &grid(&cells), UnknownIs::Free));
        prop_assert!(limited.reach() >= reach);
        for linear in 0..SIDE * SIDE {
            let cell = whole.geometry().cell(linear);
            prop_assert!((limited.at_cell(cell) - whole.at_cell(cell).min(limited.reach())).abs() < 1e-6);
        }
    }

    #[test]
    fn between_centres_the_distance_lies_between_those_of_the_centres_around(cells in any_cells(), point in any_point()) {
        let field = field(&cells);
        let low = (point - field.geometry().origin) / RESOLUTION - Vector2::repeat(0.5);
        let at = |dx: usize, dy: usize| field.at_cell(CellIndex { col: low.x as usize + dx, row: low.y as usize + dy });
        let around = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
        let (min, max) = around.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), d| (a.min(*d), b.max(*d)));
        let distance = field.distance(point);
        prop_assert!(distance >= min - 1e-9 && distance <= max + 1e-9);
    }

    #[test]
    fn no_change_costs_nothing_and_a_change_is_undone_by_its_opposite(cells in any_cells(), cell in (0..SIDE, 0..SIDE)) {
        let (first, second) = (grid(&cells), grid(&[&cells[..], &[cell]].concat()));
        let mut updated = DistanceField::from_grid(&first, UnknownIs::Free);
        let whole = updated.clone();
        prop_assert_eq!(updated.update(&first), 0);
        let changed = usize::from(!cells.contains(&cell));
        prop_assert_eq!(updated.update(&second), changed);
        prop_assert_eq!(updated.update(&first), changed);
        prop_assert_eq!(updated, whole);
    }

    #[test]
    fn the_goal_has_the_lowest_energy_and_no_force(cells in any_cells(), goal in any_point(), point in any_point()) {
        let field = field(&cells);
        let potential = PotentialField::new(&field, goal, 0.1, PotentialConfig::default());
        prop_assert_eq!(potential.energy(goal), 0.0);
        prop_assert!(potential.force(goal).norm() < 1e-12);
        prop_assert!(potential.energy(point) >= 0.5 * (goal - point).norm_squared() - 1e-12);
    }

    #[test]
    fn away_from_obstacles_the_force_is_the_attraction_alone(goal in any_point(), point in any_point(), attraction in 0.1..10.0_f64) {
        let mut config = PotentialConfig::default();
        config.attraction = attraction;
        let empty = field(&[]);
        let potential = PotentialField::new(&empty, goal, 0.1, config);
        prop_assert!((potential.force(point) - (goal - point) * attraction).norm() < 1e-9);
    }

    #[test]
    fn a_moving_obstacle_covers_its_velocity_in_a_second(position in any_point(), velocity in any_point(), time in -2.0..2.0_f64) {
        let obstacle = MovingObstacle::new(position, velocity, 0.3).unwrap();
        prop_assert_eq!(obstacle.at(0.0), position);
        prop_assert!((obstacle.at(time + 1.0) - obstacle.at(time) - velocity).norm() < 1e-12);
        prop_assert_eq!(obstacle.radius(), 0.3);
    }
}

#[test]
fn without_obstacles_every_distance_is_the_one_of_no_obstacle() {
    let empty = field(&[]);
    assert_eq!(empty.at_cell(CellIndex { col: 3, row: 5 }), NO_OBSTACLE_DISTANCE_M);
    assert_eq!(empty.gradient(Vector2::new(0.3, 1.0)), Vector2::zeros());
    assert_eq!(empty.distance(Vector2::new(f64::NAN, 0.0)), 0.0);
}

#[test]
fn the_gradient_points_away_from_a_wall_and_is_one_metre_a_metre() {
    let wall: Vec<_> = (0..SIDE).map(|row| (0, row)).collect();
    let gradient = field(&wall).gradient(Vector2::new(0.33, 1.6));
    assert!((gradient - Vector2::x()).norm() < 1e-4, "{gradient}");
}

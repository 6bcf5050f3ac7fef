//! Properties that hold on any map.

use crate::support::{at_home, clearance, found_plan, judge, planner};
use proptest::prelude::*;
use trundle_core::{Cell, GridGeometry, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::{Plan, PlannerConfig};

const RADIUS: f64 = 0.17;

prop_compose! {
    /// A room of 3 x 3 m with bars and crumbs.
    fn any_room()(
        bars in prop::collection::vec((0usize..30, 0usize..30, 1usize..12, any::<bool>()), 0..9),
        crumbs in prop::collection::vec((0usize..30, 0usize..30), 0..8),
    ) -> OccupancyGrid {
        let geometry = GridGeometry::new(0.1, Vector2::new(-1.0, 0.5), 30, 30).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        let mut put = |col: usize, row: usize| {
            if col < 30 && row < 30 {
                grid.set(trundle_core::CellIndex { col, row }, Cell::Occupied);
            }
        };
        for (col, row, length, across) in bars {
            (0..length).for_each(|i| if across { put(col + i, row) } else { put(col, row + i) });
        }
        crumbs.into_iter().for_each(|(col, row)| put(col, row));
        grid
    }
}

/// Cells that a robot on 4-neighbour moves between free centres can reach: an oracle without a distance field.
fn reachable_cells(grid: &OccupancyGrid, from: Vector2, radius: f64) -> Vec<bool> {
    let geometry = grid.geometry();
    let free: Vec<bool> =
        (0..geometry.len()).map(|i| clearance(grid, geometry.center(geometry.cell(i))) >= radius).collect();
    let mut reached = vec![false; free.len()];
    let mut stack = vec![geometry.linear(geometry.cell_at(from).unwrap())];
    while let Some(cell) = stack.pop() {
        if free[cell] && !reached[cell] {
            reached[cell] = true;
            let (col, row) = (cell % geometry.width, cell / geometry.width);
            stack.extend((col > 0).then(|| cell - 1));
            stack.extend((col + 1 < geometry.width).then_some(cell + 1));
            stack.extend((row > 0).then(|| cell - geometry.width));
            stack.extend((row + 1 < geometry.height).then_some(cell + geometry.width));
        }
    }
    reached
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn connected_means_found_and_every_plan_is_sound(
        grid in any_room(), from in 0usize..900, to in 0usize..900, a in -3.1..3.1, b in -3.1..3.1,
    ) {
        let geometry = *grid.geometry();
        let (from, to) = (geometry.cell(from), geometry.cell(to));
        let pose = |cell, heading| { let p: Vector2 = geometry.center(cell); Pose2::new(p.x, p.y, heading) };
        let (start, goal) = (pose(from, a), pose(to, b));
        // A move between two centres loses this much clearance at a corner between them.
        let sure = (RADIUS * RADIUS + 0.0025_f64).sqrt();
        let connected = reachable_cells(&grid, start.position(), sure)[geometry.linear(to)];
        let plan = planner(at_home(), RADIUS).plan(&grid, start, Twist2::ZERO, goal);
        prop_assert!(!connected || matches!(plan, Plan::Found(_)), "{plan:?}");
        if from != to && clearance(&grid, goal.position()) < RADIUS - 1e-6 {
            let refused = matches!(plan, Plan::GoalInObstacle { .. } | Plan::StartInObstacle { .. });
            prop_assert!(refused, "{plan:?}");
        }
        if let Plan::Found(result) = &plan {
            judge(&grid, result, start, goal, RADIUS.min(clearance(&grid, start.position())));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_moving_start_is_continued_or_says_that_it_is_not(
        grid in any_room(), from in 0usize..900, to in 0usize..900, heading in -3.1..3.1, v in 0.02..0.5, turn in -1.0..1.0,
    ) {
        let geometry = *grid.geometry();
        let (at, end) = (geometry.center(geometry.cell(from)), geometry.center(geometry.cell(to)));
        prop_assume!(clearance(&grid, at) >= RADIUS && from != to);
        let (start, goal) = (Pose2::new(at.x, at.y, heading), Pose2::new(end.x, end.y, 0.0));
        let twist = Twist2::new(v, turn * v / 0.3);
        if let Plan::Found(result) = planner(at_home(), RADIUS).plan(&grid, start, twist, goal) {
            judge(&grid, &result, start, goal, RADIUS);
            let first = result.trajectory.points()[0].twist;
            let kept = (first.v - v).abs() < 1e-9 && (first.omega - twist.omega).abs() < 1e-4;
            prop_assert!(if result.is_continuous { kept } else { first == Twist2::ZERO }, "{first:?} {twist:?}");
        }
    }

    #[test]
    fn an_open_floor_gives_one_curve_with_both_headings(
        x in 2.0..4.0, y in -1.5..1.5, start in -0.9..0.9, end in -1.2..1.2,
    ) {
        let grid = OccupancyGrid::from_ascii(0.1, &vec![".".repeat(80); 80].join("\n")).unwrap();
        let from = Pose2::new(2.0, 4.0, 0.0);
        let angle = f64::atan2(y, x);
        let (start, goal) = (Pose2::new(2.0, 4.0, angle + start), Pose2::new(2.0 + x, 4.0 + y, angle + end));
        let result = found_plan(planner(into_headings(), RADIUS).plan(&grid, start, Twist2::ZERO, goal));
        judge(&grid, &result, start, goal, RADIUS);
        prop_assert!(from.distance(&start) == 0.0 && result.phases.len() == 1, "{:?}", result.phases);
        let curve = result.curves().next().unwrap();
        for (s, pose) in [(0.0, start), (curve.span(), goal)] {
            let tangent = curve.derivative(s);
            prop_assert!((curve.position(s) - pose.position()).norm() < 1e-6);
            prop_assert!(tangent.perp(&pose.direction()).abs() < 1e-6 * tangent.norm());
            prop_assert!(tangent.dot(&pose.direction()) > 0.0, "reversed tangent");
        }
    }
}

/// Curves into both headings, however much longer.
fn into_headings() -> PlannerConfig {
    let mut config = at_home();
    config.curve.detour = 10.0;
    config
}

#[test]
fn pieces_meet_in_position_heading_and_curvature() {
    let grid = OccupancyGrid::from_ascii(0.1, &vec![".".repeat(120); 60].join("\n")).unwrap();
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.7), Pose2::new(11.0, 5.0, 1.2));
    let result = found_plan(planner(at_home(), RADIUS).plan(&grid, start, Twist2::ZERO, goal));
    let curve = result.curves().next().unwrap();
    assert!(curve.pieces().len() > 5);
    for pair in curve.pieces().windows(2) {
        assert_eq!(pair[0].position(1.0), pair[1].position(0.0));
        assert!((pair[0].derivative(1.0) - pair[1].derivative(0.0)).norm() < 1e-6);
        assert!((pair[0].second_derivative(1.0) - pair[1].second_derivative(0.0)).norm() < 1e-5);
    }
}

#[test]
fn headings_straight_up_and_down_are_not_singular() {
    let grid = OccupancyGrid::from_ascii(0.1, &vec![".".repeat(60); 60].join("\n")).unwrap();
    for (a, b) in [(90.0, 90.0), (-90.0, -90.0), (90.0, 180.0), (-90.0, 0.0)] {
        let up = f64::signum(a);
        let start = Pose2::new(3.0, 3.0 - 1.5 * up, f64::to_radians(a));
        let goal = Pose2::new(3.2, 3.0 + 1.5 * up, f64::to_radians(b));
        let result = found_plan(planner(into_headings(), RADIUS).plan(&grid, start, Twist2::ZERO, goal));
        assert_eq!(result.phases.len(), 1, "{a} {b}");
        judge(&grid, &result, start, goal, RADIUS);
    }
}

//! Starts too near to an obstacle, on every cell size: the path leads out, no deeper, and keeps clear of all other obstacles.

use crate::support::{at_home, clearance, found_plan, planner};
use proptest::prelude::*;
use trundle_core::{
    Cell, CellIndex, DifferentialDrive, Footprint, GridGeometry, OccupancyGrid, Pose2, Twist2, Vector2,
};
use trundle_planning::{Plan, PlanResult, Planner, Replan};

const RADIUS: f64 = 0.17;

/// Occupied squares: their distances from a point, m, within a metre.
fn squares(grid: &OccupancyGrid, point: Vector2) -> Vec<(usize, f64)> {
    let (geometry, half) = (grid.geometry(), grid.geometry().resolution / 2.0);
    let gap =
        |i: usize| (point - geometry.center(geometry.cell(i))).abs().map(|d| (d - half).max(0.0)).norm();
    let occupied = (0..geometry.len()).filter(|i| grid.cells()[*i] == Cell::Occupied);
    occupied.map(|i| (i, gap(i))).filter(|(_, d)| *d < 1.0).collect()
}

/// Near the start: the clearance from the near obstacle does not shrink, and the full radius applies to all others. Farther away: the full
/// radius applies to all.
fn judge_escape(grid: &OccupancyGrid, plan: &PlanResult, start: Pose2) {
    const ROUNDING: f64 = 3e-4;
    let resolution = grid.geometry().resolution;
    let there = squares(grid, start.position());
    let min = there.iter().map(|(_, d)| *d).fold(RADIUS, f64::min);
    let zone = RADIUS - min + f64::max(0.2, 3.0 * resolution) + 1e-3;
    let beside: Vec<usize> =
        there.iter().filter(|(_, d)| *d < RADIUS + 2.0 * resolution + 1e-6).map(|(i, _)| *i).collect();
    for point in plan.trajectory.points() {
        let near = point.pose.distance(&start) <= zone;
        for (square, distance) in squares(grid, point.pose.position()) {
            let required = if near && beside.contains(&square) { min } else { RADIUS };
            assert!(
                distance >= required - ROUNDING,
                "{distance} of {required} at {:?}, start {start:?}",
                point.pose
            );
        }
    }
}

prop_compose! {
    /// A room of 20 x 20 cells with bars and crumbs.
    fn any_room()(
        resolution in prop::sample::select(vec![0.03, 0.05, 0.1, 0.2, 0.35]),
        bars in prop::collection::vec((0usize..20, 0usize..20, 1usize..9, any::<bool>()), 1..6),
        crumbs in prop::collection::vec((0usize..20, 0usize..20), 0..5),
    ) -> OccupancyGrid {
        let geometry = GridGeometry::new(resolution, Vector2::new(-1.0, 0.5), 20, 20).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        let mut put = |col: usize, row: usize| {
            if col < 20 && row < 20 {
                grid.set(CellIndex { col, row }, Cell::Occupied);
            }
        };
        for (col, row, length, across) in bars {
            (0..length).for_each(|i| if across { put(col + i, row) } else { put(col, row + i) });
        }
        crumbs.into_iter().for_each(|(col, row)| put(col, row));
        grid
    }
}

fn cart() -> Planner {
    let corners = [(0.3, 0.1), (-0.06, 0.1), (-0.06, -0.1), (0.3, -0.1)].map(|(x, y)| Vector2::new(x, y));
    let footprint = Footprint::polygon(corners.to_vec()).unwrap();
    Planner::new(at_home(), &footprint, crate::support::LIMITS, DifferentialDrive::KOBUKI).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_disc_comes_no_deeper_and_the_plan_is_free_where_it_begins(
        grid in any_room(), which in 0usize..400, bearing in -3.1..3.1, missing in 1e-3..0.06, to in 0usize..400,
    ) {
        let occupied: Vec<_> = squares(&grid, Vector2::new(-0.5, 1.0)).iter().map(|(i, _)| *i).collect();
        prop_assume!(!occupied.is_empty());
        let beside = grid.geometry().center(grid.geometry().cell(occupied[which % occupied.len()]));
        // Straight off a square, until that clearance is missing.
        let along = Vector2::new(f64::cos(bearing), f64::sin(bearing));
        let off = |t: f64| beside + along * t;
        let steps = (0..2000).map(|k| f64::from(k) * 1e-3);
        let Some(out) = steps.map(off).find(|p| clearance(&grid, *p) >= RADIUS - missing) else { return Ok(()) };
        if clearance(&grid, out) >= RADIUS || grid.geometry().cell_at(out).is_none() {
            return Ok(());
        }
        let start = Pose2::new(out.x, out.y, bearing * 0.7);
        let end = grid.geometry().center(grid.geometry().cell(to));
        let mut planner = planner(at_home(), RADIUS);
        if let Plan::Found(plan) = planner.plan(&grid, start, Twist2::ZERO, Pose2::new(end.x, end.y, 0.3)) {
            judge_escape(&grid, &plan, start);
            prop_assert_eq!(planner.validate_trajectory(&grid, &plan.trajectory, 0.0), Ok(()));
        }
    }

    #[test]
    fn an_outlines_plan_out_of_something_is_free_where_it_begins(
        grid in any_room(), at in (0.0..1.0, 0.0..1.0), to in 0usize..400, heading in -3.1..3.1,
    ) {
        let side = 20.0 * grid.geometry().resolution;
        let start = Pose2::new(-1.0 + at.0 * side, 0.5 + at.1 * side, heading);
        let end = grid.geometry().center(grid.geometry().cell(to));
        let mut planner = cart();
        if let Plan::Found(plan) = planner.plan(&grid, start, Twist2::ZERO, Pose2::new(end.x, end.y, 0.3)) {
            prop_assert_eq!(planner.validate_trajectory(&grid, &plan.trajectory, 0.0), Ok(()));
        }
    }
}

/// A wall below; 1.2 m of floor above it.
fn beside_a_wall(resolution: f64) -> OccupancyGrid {
    let geometry = GridGeometry::new(resolution, Vector2::zeros(), 30, 14).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    (0..30).for_each(|col| grid.set(CellIndex { col, row: 0 }, Cell::Occupied));
    grid
}

/// A start that the planner accepts is accepted by the path validation on the whole path: no plan is made twice.
#[test]
fn coarse_cells_do_not_cause_a_livelock() {
    for resolution in [0.05, 0.1, 0.2, 0.4] {
        let grid = beside_a_wall(resolution);
        let start = Pose2::new(5.0 * resolution, resolution + RADIUS - 0.04, 0.0);
        let goal = Pose2::new(25.0 * resolution, 9.0 * resolution, 0.0);
        for mut planner in [planner(at_home(), RADIUS), cart()] {
            let plan = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
            for k in 0..20 {
                let time = plan.trajectory.duration() * f64::from(k) / 20.0;
                assert_eq!(planner.replan(&grid, &[], &plan, time, goal), Replan::Keep, "{resolution}: {k}");
            }
        }
    }
}

/// Only the obstacle of the start may be overlapped: a too narrow gap is closed even for a robot that has just left a wall.
#[test]
fn leaving_a_wall_does_not_open_a_gap_that_is_too_narrow() {
    let mut grid = beside_a_wall(0.1);
    let start = Pose2::new(0.95, 0.1 + 0.16 - 0.04, std::f64::consts::FRAC_PI_2);
    let goal = Pose2::new(0.95, 1.1, 0.0);
    (0..30)
        .filter(|col| !(8..=10).contains(col))
        .for_each(|col| grid.set(CellIndex { col, row: 4 }, Cell::Occupied));
    found_plan(planner(at_home(), 0.149).plan(&grid, start, Twist2::ZERO, goal));
    let plan = planner(at_home(), 0.16).plan(&grid, start, Twist2::ZERO, goal);
    assert!(matches!(plan, Plan::Blocked { nearest } if nearest.y < 0.4), "{plan}");
}

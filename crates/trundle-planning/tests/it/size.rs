//! Large and strange maps.

use crate::support::{at_home, found_plan, judge, planner};
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2, Twist2, Vector2};

/// Walls every 100 cells with an opening at alternating ends: the path is long.
fn meander(size: usize) -> OccupancyGrid {
    let geometry = GridGeometry::new(0.05, Vector2::zeros(), size, size).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    for (i, col) in (100..size).step_by(100).enumerate() {
        let rows = if i % 2 == 0 { 0..size - 20 } else { 20..size };
        rows.for_each(|row| grid.set(CellIndex { col, row }, Cell::Occupied));
    }
    grid
}

fn across(size: usize) {
    let grid = meander(size);
    let side = size as f64 * 0.05;
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.0), Pose2::new(side - 1.0, side / 2.0, 1.0));
    let mut planner = planner(at_home(), 0.1755);
    let begin = crate::support::cpu_ms();
    let result = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    let spent = crate::support::cpu_ms() - begin;
    eprintln!(
        "{size} x {size}: {spent:.0} ms CPU for {:.0} m, {} way-points",
        result.length,
        result.waypoints.points().len()
    );
    judge(&grid, &result, start, goal, 0.1755);
}

/// Boxes of a metre, two and a half metres apart, shifted from row to row.
fn warehouse(size: usize) -> OccupancyGrid {
    let geometry = GridGeometry::new(0.05, Vector2::zeros(), size, size).unwrap();
    let cell = |i: usize| {
        let (col, row) = (i % size, i / size);
        let is_box = row % 50 >= 30 && (col + row / 50 * 17) % 50 >= 30;
        if is_box { Cell::Occupied } else { Cell::Free }
    };
    OccupancyGrid::new(geometry, (0..geometry.len()).map(cell).collect()).unwrap()
}

#[test]
fn a_warehouse_of_a_thousand_cells_square() {
    let grid = warehouse(1000);
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.0), Pose2::new(48.0, 46.0, 1.0));
    let mut planner = planner(at_home(), 0.1755);
    for round in ["new field", "same field"] {
        let begin = crate::support::cpu_ms();
        let result = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
        let spent = crate::support::cpu_ms() - begin;
        eprintln!("warehouse, {round}: {spent:.0} ms CPU for {:.0} m", result.length);
        judge(&grid, &result, start, goal, 0.1755);
    }
}

#[test]
fn a_thousand_cells_square() {
    across(1000);
}

/// 200 x 200 m in cells of 5 cm with a new planner: field and plan within one second of a core and 400 MB. The time is the best of two,
/// because the machine may be busy; the peak memory is that of the whole process with all its tests.
#[test]
fn sixteen_million_cells_in_a_second() {
    let grid = warehouse(4000);
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.0), Pose2::new(195.0, 195.0, 1.0));
    let ask = || {
        let mut planner = planner(at_home(), 0.26);
        let begin = crate::support::cpu_ms();
        let plan = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
        (crate::support::cpu_ms() - begin, plan)
    };
    let ((first, plan), (second, same)) = (ask(), ask());
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or("0 kB");
    let peak: f64 = peak.trim().trim_end_matches(" kB").parse().unwrap();
    eprintln!("4000 x 4000: {first:.0} and {second:.0} ms CPU for {:.0} m, {peak} kB", plan.length);
    assert_eq!(plan, same);
    assert!(first.min(second) < 1000.0 && peak < 400e3, "{first} {second} ms, {peak} kB");
}

//! Gaps that the footprint fits by a hair, of odd and even numbers of cells, along the axes and across them.

use crate::support::{LIMITS, at_home, found_plan, judge, planner};
use trundle_core::{DifferentialDrive, Footprint, Hypotenuse, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::{Plan, Planner};

/// Side of a cell, m.
const SIDE_M: f64 = 0.05;
/// Clearance left on either side, m.
const SPARE_M: f64 = 1e-3;

/// An open area of 60 x 60 cells with a wall that `is_wall` gives.
fn area(is_wall: impl Fn(usize, usize) -> bool) -> OccupancyGrid {
    let row = |row: usize| (0..60).map(|col| if is_wall(col, row) { '#' } else { '.' }).collect::<String>();
    let art: Vec<String> = (0..60).rev().map(row).collect();
    OccupancyGrid::from_ascii(SIDE_M, &art.join("\n")).unwrap()
}

/// Plans across the diagonal of the area for discs a little narrower and a little wider than a gap of `width` m.
fn fits_and_does_not(grid: &OccupancyGrid, width: f64, name: &str) {
    let (start, goal) = (Pose2::new(0.62, 0.57, 0.3), Pose2::new(2.41, 2.37, 1.0));
    let through = planner(at_home(), width / 2.0 - SPARE_M).plan(grid, start, Twist2::ZERO, goal);
    assert!(matches!(through, Plan::Found(_)), "{name}: {through}");
    judge(grid, &found_plan(through), start, goal, width / 2.0 - SPARE_M);
    let wider = planner(at_home(), width / 2.0 + SPARE_M).plan(grid, start, Twist2::ZERO, goal);
    assert!(matches!(wider, Plan::Blocked { .. }), "{name}: {wider}");
}

#[test]
fn a_door_lets_through_what_fits_whatever_its_number_of_cells() {
    for cells in 3..=10 {
        for thick in [1, 3] {
            let door = 25..25 + cells;
            let upright = area(|col, row| (29..29 + thick).contains(&col) && !door.contains(&row));
            fits_and_does_not(&upright, cells as f64 * SIDE_M, &format!("upright, {cells} x {thick} cells"));
            let level = area(|col, row| (29..29 + thick).contains(&row) && !door.contains(&col));
            fits_and_does_not(&level, cells as f64 * SIDE_M, &format!("level, {cells} x {thick} cells"));
        }
    }
}

#[test]
fn a_gap_between_two_corners_lets_through_what_fits() {
    for (right, up) in [(3, 3), (4, 4), (4, 3), (5, 2), (6, 3), (7, 4), (5, 5), (6, 1)] {
        // Two walls that end in corners `right` columns and `up` rows apart.
        let grid = area(|col, row| {
            (row == 30 && col <= 25)
                || (row == 30 + up && col >= 25 + right)
                || (row > 30 && row < 30 + up && col == 59)
        });
        let faces = (right as f64 - 1.0, up as f64 - 1.0);
        let width = faces.0.hypotenuse(faces.1) * SIDE_M;
        fits_and_does_not(&grid, width, &format!("{right} right, {up} up"));
    }
}

#[test]
fn a_long_robot_passes_a_door_of_its_width_from_beside() {
    for cells in 6..=7 {
        let door = 25..25 + cells;
        let grid = area(|col, row| (29..31).contains(&col) && !door.contains(&row));
        let width = cells as f64 * SIDE_M;
        let plan = |spare: f64, from_y: f64| {
            let (long, wide) = (0.3, width / 2.0 - spare);
            let corners = [(long, wide), (-long, wide), (-long, -wide), (long, -wide)];
            let footprint = Footprint::polygon(corners.map(|(x, y)| Vector2::new(x, y)).to_vec()).unwrap();
            let (start, goal) = (Pose2::new(0.62, from_y, 0.3), Pose2::new(2.41, 1.37, 1.0));
            Planner::new(at_home(), &footprint, LIMITS, DifferentialDrive::KOBUKI).unwrap().plan(
                &grid,
                start,
                Twist2::ZERO,
                goal,
            )
        };
        for from_y in [0.61, 1.53] {
            let through = plan(SPARE_M, from_y);
            assert!(matches!(through, Plan::Found(_)), "{cells} cells from {from_y}: {through}");
        }
        let wider = plan(-SPARE_M, 1.2);
        assert!(matches!(wider, Plan::Blocked { .. }), "{cells} cells: {wider}");
    }
}

//! Plans on moved, turned and mirrored maps, and on maps that are the same for the robot.

use crate::support::{at_home, found_plan, judge, planner};
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::{Plan, PlanResult};

const RADIUS: f64 = 0.17;
/// Side of the map, cells and m.
const SIDE: usize = 40;
const SIDE_M: f64 = 4.0;

/// A room with two walls that leave one path, which is the shortest one by far.
fn occupied(col: usize, row: usize) -> bool {
    (col == 13 && row < 28) || (col == 26 && row > 11)
}

fn room_of(origin: Vector2, occupied: impl Fn(usize, usize) -> bool) -> OccupancyGrid {
    let geometry = GridGeometry::new(0.1, origin, SIDE, SIDE).unwrap();
    let cell = |linear: usize| {
        let CellIndex { col, row } = geometry.cell(linear);
        if occupied(col, row) { Cell::Occupied } else { Cell::Free }
    };
    OccupancyGrid::new(geometry, (0..geometry.len()).map(cell).collect()).unwrap()
}

fn start() -> Pose2 {
    Pose2::new(0.6, 0.7, 1.2)
}

fn goal() -> Pose2 {
    Pose2::new(3.4, 3.2, 1.0)
}

fn planned(grid: &OccupancyGrid, start: Pose2, goal: Pose2) -> Box<PlanResult> {
    let plan = found_plan(planner(at_home(), RADIUS).plan(grid, start, Twist2::ZERO, goal));
    judge(grid, &plan, start, goal, RADIUS);
    plan
}

/// Both plans are equally long and fast, up to the choice between equal paths.
fn assert_alike(a: &PlanResult, b: &PlanResult) {
    let (times, lengths) = ([a, b].map(|plan| plan.trajectory.duration()), [a, b].map(|plan| plan.length));
    assert!((lengths[0] - lengths[1]).abs() < 0.03 * lengths[0], "{lengths:?} m");
    assert!((times[0] - times[1]).abs() < 0.08 * times[0], "{times:?} s");
}

#[test]
fn a_moved_map_moves_the_plan() {
    let here = planned(&room_of(Vector2::zeros(), occupied), start(), goal());
    for shift in [Vector2::new(12.8, -6.4), Vector2::new(-100.0, 250.0)] {
        let moved = |pose: Pose2| Pose2 { x: pose.x + shift.x, y: pose.y + shift.y, ..pose };
        let there = planned(&room_of(shift, occupied), moved(start()), moved(goal()));
        let times = [&here, &there].map(|plan| plan.trajectory.duration());
        assert!((times[0] - times[1]).abs() < 1e-2, "{times:?} s at {shift}");
        for i in 0..=50 {
            let time = here.trajectory.duration() * f64::from(i) / 50.0;
            let off = moved(here.trajectory.at(time).pose).distance(&there.trajectory.at(time).pose);
            assert!(off < 1e-2, "{off} m at {time} s");
        }
    }
}

#[test]
fn a_mirrored_map_has_a_plan_of_the_same_length_and_time() {
    let here = planned(&room_of(Vector2::zeros(), occupied), start(), goal());
    let mirror = |pose: Pose2| Pose2::new(pose.x, SIDE_M - pose.y, -pose.theta);
    let flipped = room_of(Vector2::zeros(), |col, row| occupied(col, SIDE - 1 - row));
    assert_alike(&here, &planned(&flipped, mirror(start()), mirror(goal())));
}

#[test]
fn a_map_turned_by_a_quarter_has_a_plan_of_the_same_length_and_time() {
    let here = planned(&room_of(Vector2::zeros(), occupied), start(), goal());
    let quarter = |pose: Pose2| Pose2::new(SIDE_M - pose.y, pose.x, pose.theta + std::f64::consts::FRAC_PI_2);
    let turned = room_of(Vector2::zeros(), |col, row| occupied(row, SIDE - 1 - col));
    assert_alike(&here, &planned(&turned, quarter(start()), quarter(goal())));
}

#[test]
fn the_path_back_is_as_long() {
    let (grid, about) = (room_of(Vector2::zeros(), occupied), Pose2::new(0.0, 0.0, std::f64::consts::PI));
    let (forth, back) = (planned(&grid, start(), goal()), planned(&grid, goal() * about, start() * about));
    assert!(
        (forth.length - back.length).abs() < 0.04 * forth.length,
        "{} m and {} m",
        forth.length,
        back.length
    );
}

#[test]
fn no_path_is_shorter_than_the_straight_line_or_faster_than_the_robot() {
    let grid = room_of(Vector2::zeros(), occupied);
    for (x, y) in [(3.4, 3.2), (0.6, 3.0), (2.0, 0.5), (2.0, 3.4)] {
        let goal = Pose2::new(x, y, 0.3);
        let plan = planned(&grid, start(), goal);
        assert!(plan.length >= start().distance(&goal) - 2e-3);
        assert!(plan.trajectory.duration() >= plan.length / 0.70);
        assert!(plan.waypoints.length() >= start().distance(&goal) - 1e-9);
    }
}

#[test]
fn a_wider_robot_keeps_farther_away_until_it_no_longer_fits() {
    let grid = room_of(Vector2::zeros(), |col, row| row == 20 && !(15..22).contains(&col));
    let (start, goal) = (Pose2::new(1.85, 0.7, 1.57), Pose2::new(1.85, 3.3, 1.57));
    let plan = |radius: f64| planner(at_home(), radius).plan(&grid, start, Twist2::ZERO, goal);
    for radius in [0.1, 0.2, 0.34] {
        judge(&grid, &found_plan(plan(radius)), start, goal, radius);
    }
    assert!(matches!(plan(0.36), Plan::Blocked { nearest } if nearest.y < 2.0), "{}", plan(0.36));
}

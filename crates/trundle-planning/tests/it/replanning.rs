//! Plans that start from a motion.

use crate::support::{at_home, found_plan, judge, planner};
use trundle_core::{Cell, CellIndex, OccupancyGrid, Pose2, Twist2};

fn hall() -> OccupancyGrid {
    OccupancyGrid::from_ascii(0.1, &vec![".".repeat(100); 60].join("\n")).unwrap()
}

#[test]
fn a_new_goal_is_taken_up_without_a_jerk() {
    let grid = hall();
    let mut planner = planner(at_home(), 0.1755);
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.3), Pose2::new(8.0, 4.0, 0.0));
    let first = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    for time in [1.0, 3.0, 6.0] {
        let now = first.trajectory.at(time);
        let other = Pose2::new(8.0, 2.0, 0.5);
        let second = found_plan(planner.plan(&grid, now.pose, now.twist, other));
        assert!(second.is_continuous);
        judge(&grid, &second, now.pose, other, 0.1755);
        let begin = second.trajectory.points()[0];
        assert!((begin.twist.v - now.twist.v).abs() < 1e-9, "{now:?} {begin:?}");
        assert!((begin.twist.omega - now.twist.omega).abs() < 1e-5, "{now:?} {begin:?}");
    }
}

#[test]
fn a_goal_behind_is_reached_after_braking() {
    let grid = hall();
    let start = Pose2::new(5.0, 3.0, 0.0);
    let goal = Pose2::new(2.0, 3.0, 0.0);
    let result = found_plan(planner(at_home(), 0.1755).plan(&grid, start, Twist2::new(0.6, 0.0), goal));
    assert!(result.is_continuous);
    assert_eq!(result.trajectory.points()[0].twist.v, 0.6);
    judge(&grid, &result, start, goal, 0.1755);
}

#[test]
fn a_turning_robot_brakes_on_its_arc() {
    let grid = hall();
    let start = Pose2::new(5.0, 3.0, 0.0);
    let goal = Pose2::new(2.0, 2.0, 0.0);
    let twist = Twist2::new(0.4, 1.0);
    let result = found_plan(planner(at_home(), 0.1755).plan(&grid, start, twist, goal));
    assert!(result.is_continuous);
    assert!((result.trajectory.points()[0].twist.omega - 1.0).abs() < 1e-9);
    judge(&grid, &result, start, goal, 0.1755);
}

#[test]
fn something_new_in_the_way_is_noticed_and_planned_around() {
    let mut grid = hall();
    let mut planner = planner(at_home(), 0.1755);
    let (start, goal) = (Pose2::new(1.0, 3.0, 0.0), Pose2::new(9.0, 3.0, 0.0));
    let plan = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    assert!(planner.validate_trajectory(&grid, &plan.trajectory, 0.0).is_ok());
    (25..35).for_each(|row| grid.set(CellIndex { col: 50, row }, Cell::Occupied));
    let hit = planner.validate_trajectory(&grid, &plan.trajectory, 0.0).unwrap_err();
    assert!(hit.time > 3.0 && (hit.pose.x - 4.8245).abs() < 0.02, "{hit}");
    let now = plan.trajectory.at(4.0);
    let around = found_plan(planner.plan(&grid, now.pose, now.twist, goal));
    assert!(around.is_continuous);
    judge(&grid, &around, now.pose, goal, 0.1755);
    assert!(planner.validate_trajectory(&grid, &around.trajectory, 0.0).is_ok());
}

#[test]
fn the_same_question_gives_the_same_answer() {
    let grid = hall();
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.3), Pose2::new(8.0, 4.0, 0.0));
    let mut warm = planner(at_home(), 0.1755);
    let first = warm.plan(&grid, start, Twist2::ZERO, goal);
    assert_eq!(first, warm.plan(&grid, start, Twist2::ZERO, goal));
    assert_eq!(first, planner(at_home(), 0.1755).plan(&grid, start, Twist2::ZERO, goal));
}

//! Paths on maps that a person can see.

use crate::support::{at_home, found_plan, judge, planner};
use trundle_core::{OccupancyGrid, Pose2, Twist2};
use trundle_planning::{Plan, PlannerConfig, PotentialKind};

const TRAP: &str = "
    ##############################
    #............................#
    #............................#
    #............................#
    #.......############.........#
    #..................#.........#
    #..................#.........#
    #..................#.........#
    #..................#.........#
    #..................#.........#
    #..................#.........#
    #.......############.........#
    #............................#
    #............................#
    #............................#
    ##############################";

/// The map with the driven path drawn over it.
fn drawn(grid: &OccupancyGrid, art: &str, plan: &trundle_planning::PlanResult) -> String {
    let lines: Vec<&str> = art.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let mut picture: Vec<Vec<char>> = lines.iter().map(|line| line.chars().collect()).collect();
    let mut put = |at: trundle_core::Vector2, with: char| {
        let cell = grid.geometry().cell_at(at).unwrap();
        let row = picture.len() - 1 - cell.row;
        picture[row][cell.col] = with;
    };
    for point in plan.trajectory.points() {
        put(point.pose.position(), '*');
    }
    for point in plan.waypoints.points() {
        put(*point, 'o');
    }
    picture.into_iter().map(|row| row.into_iter().collect::<String>() + "\n").collect()
}

#[test]
fn out_of_the_u_by_the_geodesic_potential() {
    let grid = OccupancyGrid::from_ascii(0.2, TRAP).unwrap();
    let (start, goal) = (Pose2::new(2.5, 1.7, 0.0), Pose2::new(5.1, 1.5, std::f64::consts::FRAC_PI_2));
    let result = found_plan(planner(at_home(), 0.1755).plan(&grid, start, Twist2::ZERO, goal));
    assert!(!result.fell_back);
    judge(&grid, &result, start, goal, 0.1755);
    insta::assert_snapshot!(drawn(&grid, TRAP, &result));
}

#[test]
fn the_printed_potential_is_trapped_and_rescued() {
    let grid = OccupancyGrid::from_ascii(0.2, TRAP).unwrap();
    let (start, goal) = (Pose2::new(2.5, 1.7, 0.0), Pose2::new(5.1, 1.5, 0.0));
    let mut config = at_home();
    config.potential.kind = PotentialKind::Printed;
    let mut planner = planner(config, 0.1755);
    let rescued = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    assert!(rescued.fell_back);
    judge(&grid, &rescued, start, goal, 0.1755);
    let near = Pose2::new(0.7, 0.7, 0.0);
    let direct = found_plan(planner.plan(&grid, near, Twist2::ZERO, Pose2::new(4.9, 0.5, 0.0)));
    assert!(!direct.fell_back, "an open path needs no fallback");
}

#[test]
fn a_door_as_wide_as_the_robot_is_passed_and_a_narrower_one_is_not() {
    let art = "
        ####################
        #.........#........#
        #.........#........#
        #..................#
        #..................#
        #..................#
        #.........#........#
        #.........#........#
        #.........#........#
        ####################";
    let grid = OccupancyGrid::from_ascii(0.2, art).unwrap();
    let (start, goal) = (Pose2::new(0.8, 1.4, 0.0), Pose2::new(3.0, 0.6, 0.0));
    let result = found_plan(planner(at_home(), 0.299).plan(&grid, start, Twist2::ZERO, goal));
    judge(&grid, &result, start, goal, 0.299);
    let blocked = planner(at_home(), 0.301).plan(&grid, start, Twist2::ZERO, goal);
    assert!(matches!(blocked, Plan::Blocked { nearest } if nearest.x < 2.2), "{blocked:?}");
}

#[test]
fn the_goals_of_the_paper_from_all_sides() {
    // [Li18], A8: heading 0 at eight places around, the goal in the middle with heading 90 deg.
    let grid = OccupancyGrid::from_ascii(0.1, &vec![".".repeat(80); 80].join("\n")).unwrap();
    let goal = Pose2::new(4.0, 4.0, std::f64::consts::FRAC_PI_2);
    for (dx, dy) in
        [(0.0, 2.4), (2.4, 2.4), (2.4, 0.0), (2.4, -2.4), (0.0, -2.4), (-2.4, -2.4), (-2.4, 0.0), (-2.4, 2.4)]
    {
        let start = Pose2::new(4.0 + dx, 4.0 + dy, 0.0);
        let result = found_plan(planner(at_home(), 0.1755).plan(&grid, start, Twist2::ZERO, goal));
        judge(&grid, &result, start, goal, 0.1755);
        let straight = start.distance(&goal);
        eprintln!(
            "{dx} {dy}: {:.2} m for {straight:.2} in {:.1} s",
            result.length,
            result.trajectory.duration()
        );
        assert!(result.length < 1.4 * straight);
    }
}

#[test]
fn a_goal_beyond_a_tiny_grid_is_planned_through_the_unknown() {
    let art = "
        ??????????
        ??......??
        ??......#?
        ??......#?
        ??......#?
        ??......??
        ??????????";
    let grid = OccupancyGrid::from_ascii(0.2, art).unwrap();
    let (start, goal) = (Pose2::new(0.9, 0.7, 0.0), Pose2::new(6.0, 0.7, 0.0));
    let result = found_plan(planner(PlannerConfig::default(), 0.1755).plan(&grid, start, Twist2::ZERO, goal));
    judge(&grid, &result, start, goal, 0.1755);
}

#[test]
fn a_robot_parked_at_a_wall_plans_its_way_out() {
    let grid =
        OccupancyGrid::from_ascii(0.1, &["#".repeat(30), vec![".".repeat(30); 20].join("\n")].join("\n"))
            .unwrap();
    for gap in [0.16, 0.1756, 0.19] {
        let start = Pose2::new(1.0, 2.0 - gap, 0.0);
        let goal = Pose2::new(2.5, 0.5, 0.0);
        let result = found_plan(planner(at_home(), 0.1755).plan(&grid, start, Twist2::ZERO, goal));
        judge(&grid, &result, start, goal, gap.min(0.1755));
    }
    let start = Pose2::new(1.0, 1.95, 0.0);
    let refused = planner(at_home(), 0.1755).plan(&grid, start, Twist2::ZERO, Pose2::new(2.5, 0.5, 0.0));
    assert!(
        matches!(refused, Plan::StartInObstacle { clearance } if (clearance + 0.1255).abs() < 1e-3),
        "{refused:?}"
    );
}

#[test]
fn a_known_way_is_preferred_to_the_unknown() {
    let art = "
        ....................
        ....................
        ....................
        ....................
        ......??????????....
        ......??????????....
        ......??????????....
        ......??????????....";
    let grid = OccupancyGrid::from_ascii(0.25, art).unwrap();
    let (start, goal) = (Pose2::new(1.2, 0.9, 0.0), Pose2::new(4.4, 0.9, 0.0));
    let through = found_plan(planner(at_home(), 0.17).plan(&grid, start, Twist2::ZERO, goal));
    assert!(through.length < 3.4, "{}", through.length);
    let mut config = at_home();
    config.room.unknown_weight = 3.0;
    let around = found_plan(planner(config, 0.17).plan(&grid, start, Twist2::ZERO, goal));
    assert!(around.waypoints.points().iter().any(|p| p.y > 1.0), "{:?}", around.waypoints);
}

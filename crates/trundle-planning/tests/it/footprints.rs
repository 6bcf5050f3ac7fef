//! Robots that are not discs: long ones with an axle outside the middle.

use crate::outline_judge::{judge_outline, touches};
use crate::support::{LIMITS, at_home, found_plan};
use trundle_core::{
    Cell, CellIndex, DifferentialDrive, Footprint, GridGeometry, OccupancyGrid, Pose2, Twist2, Vector2,
};
use trundle_planning::{Phase, Plan, PlanResult, Planner, PlannerConfig};

/// 0.6 x 0.4 m, the axle 0.2 m behind the middle.
fn cart() -> Vec<Vector2> {
    [(0.5, 0.2), (-0.1, 0.2), (-0.1, -0.2), (0.5, -0.2)].map(|(x, y)| Vector2::new(x, y)).to_vec()
}

fn cart_planner(config: PlannerConfig) -> Planner {
    let footprint = Footprint::polygon(cart()).unwrap();
    Planner::new(config, &footprint, LIMITS, DifferentialDrive::KOBUKI).unwrap()
}

fn judge_cart(grid: &OccupancyGrid, result: &PlanResult, start: Pose2, goal: Pose2) {
    judge_outline(grid, &cart(), result, (start, goal));
}

/// Two areas of 1.5 x 1.7 m with a corridor between them, `corridor` cells of 0.1 m wide.
fn two_rooms(corridor: usize) -> OccupancyGrid {
    let row = |r: usize| {
        let open = r > 0 && r < 18;
        let between = if open && r.abs_diff(9) * 2 < corridor { "." } else { "#" };
        let room = if open { "." } else { "#" };
        format!("#{}{}{}#", room.repeat(15), between.repeat(14), room.repeat(15))
    };
    OccupancyGrid::from_ascii(0.1, &(0..19).map(row).collect::<Vec<_>>().join("\n")).unwrap()
}

#[test]
fn a_long_robot_passes_a_corridor_narrower_than_its_circle() {
    // The circle around the axle is 1.08 m across, the robot 0.4 m.
    let (start, goal) = (Pose2::new(0.7, 0.7, 1.3), Pose2::new(3.7, 1.1, -2.0));
    let result = found_plan(cart_planner(at_home()).plan(&two_rooms(5), start, Twist2::ZERO, goal));
    judge_cart(&two_rooms(5), &result, start, goal);
    assert!(result.length < 4.0, "{}", result.length);
    let plan = cart_planner(at_home()).plan(&two_rooms(3), start, Twist2::ZERO, goal);
    assert!(matches!(plan, Plan::Blocked { nearest } if nearest.x < 2.0), "{plan}");
}

#[test]
fn in_the_open_the_circle_is_the_fast_path_and_the_curve_is_one() {
    let grid = OccupancyGrid::from_ascii(0.1, &vec![".".repeat(60); 60].join("\n")).unwrap();
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.6), Pose2::new(5.0, 4.0, 0.7));
    let result = found_plan(cart_planner(at_home()).plan(&grid, start, Twist2::ZERO, goal));
    assert_eq!(result.phases.len(), 1);
    judge_cart(&grid, &result, start, goal);
}

#[test]
fn where_the_short_way_round_is_blocked_it_turns_the_long_way() {
    // A wall close to the right of the robot's nose: it can only turn left.
    let art = "
        ....................
        ....................
        ....................
        ....................
        ....................
        ....................
        ....................
        ....................
        ..########..........
        ..########..........";
    let grid = OccupancyGrid::from_ascii(0.1, art).unwrap();
    let at = |theta: f64| Pose2::new(0.6, 0.45, theta);
    let (start, goal) = (at(0.0), at(-3.1));
    let result = found_plan(cart_planner(at_home()).plan(&grid, start, Twist2::ZERO, goal));
    let Phase::Turn { angle, .. } = result.phases[0] else { panic!("{:?}", result.phases) };
    assert!(angle > 3.15, "{angle}");
    judge_cart(&grid, &result, start, goal);
}

#[test]
fn an_outline_in_a_wall_is_refused_with_reasons() {
    let grid =
        OccupancyGrid::from_ascii(0.1, &["#".repeat(30), vec![".".repeat(30); 29].join("\n")].join("\n"))
            .unwrap();
    let inside = Pose2::new(1.5, 2.6, std::f64::consts::FRAC_PI_2);
    let free = Pose2::new(1.5, 1.0, 0.0);
    let plan = |a, b| cart_planner(at_home()).plan(&grid, a, Twist2::ZERO, b);
    assert!(matches!(plan(inside, free), Plan::StartInObstacle { .. }));
    assert!(matches!(plan(free, inside), Plan::GoalInObstacle { .. }));
    let beside = Pose2::new(1.5, 2.6, 0.0);
    let result = found_plan(plan(beside, free));
    judge_cart(&grid, &result, beside, free);
}

#[test]
fn a_long_robot_that_moves_is_planned_for_as_it_moves() {
    let (start, goal) = (Pose2::new(0.7, 0.7, 1.3), Pose2::new(3.7, 1.1, -2.0));
    let grid = two_rooms(5);
    let mut planner = cart_planner(at_home());
    let first = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    let (mut moving, mut continued) = (0, 0);
    for k in 1..20 {
        let now = first.trajectory.at(first.trajectory.duration() * f64::from(k) / 20.0);
        if now.twist.v < 0.05 {
            continue;
        }
        let plan = found_plan(planner.plan(&grid, now.pose, now.twist, Pose2::new(3.7, 0.8, 1.0)));
        judge_cart(&grid, &plan, now.pose, Pose2::new(3.7, 0.8, 1.0));
        let begin = plan.trajectory.points()[0].twist;
        moving += 1;
        continued += usize::from(plan.is_continuous);
        let kept = (begin.v - now.twist.v).abs() < 1e-9 && (begin.omega - now.twist.omega).abs() < 1e-3;
        assert!(if plan.is_continuous { kept } else { begin == Twist2::ZERO }, "{begin:?} {:?}", now.twist);
    }
    eprintln!("an outline under way: {continued} of {moving} plans go on from its motion");
    assert!(moving >= 8 && continued * 10 >= moving * 9, "{continued} of {moving}");
}

/// A wall above 2.9 m.
fn below_a_wall() -> OccupancyGrid {
    OccupancyGrid::from_ascii(0.1, &["#".repeat(30), vec![".".repeat(30); 29].join("\n")].join("\n")).unwrap()
}

#[test]
fn an_outline_may_touch_a_wall_and_go_along_it() {
    let grid = below_a_wall();
    // The left side is exactly on the wall at both ends.
    let (start, goal) = (Pose2::new(0.8, 2.7, 0.0), Pose2::new(2.0, 2.7, 0.0));
    let mut planner = cart_planner(at_home());
    let result = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    judge_cart(&grid, &result, start, goal);
    assert!(planner.validate_trajectory(&grid, &result.trajectory, 0.0).is_ok());
    // A wall across the path is detected although the robot touches another wall.
    let mut barred = grid.clone();
    (20..29).for_each(|row| barred.set(trundle_core::CellIndex { col: 18, row }, Cell::Occupied));
    assert!(planner.validate_trajectory(&barred, &result.trajectory, 0.0).is_err());
}

#[test]
fn an_outline_within_a_wall_is_planned_out_of_it_or_refused_with_the_depth() {
    let grid = below_a_wall();
    let goal = Pose2::new(2.0, 1.0, 0.0);
    for depth in [0.005, 0.03, 0.055] {
        // The back is inside the wall.
        let start = Pose2::new(0.8, 2.8 + depth, -std::f64::consts::FRAC_PI_2);
        let mut planner = cart_planner(at_home());
        let result = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
        assert!(result.trajectory.end().distance(&goal) < 1.1e-3);
        let left = result.trajectory.points().iter().filter(|p| p.pose.distance(&start) > depth + 0.31);
        assert_eq!(left.filter(|p| touches(&grid, &cart(), p.pose)).count(), 0, "{depth}");
        // The overlap never exceeds that of the start: a footprint smaller by this depth is free.
        let (long, wide) = (0.3 - depth - 5e-4, 0.2 - depth - 5e-4);
        let slim = [(long, wide), (-long, wide), (-long, -wide), (long, -wide)]
            .map(|(x, y)| Vector2::new(0.2 + x, y));
        assert!(result.trajectory.points().iter().all(|p| !touches(&grid, &slim, p.pose)), "{depth}");
        assert!(planner.validate_trajectory(&grid, &result.trajectory, 0.0).is_ok(), "{depth}");
    }
    // With its side inside the wall, the robot can neither turn nor back out.
    let wedged = Pose2::new(0.8, 2.71, 0.0);
    let plan = cart_planner(at_home()).plan(&grid, wedged, Twist2::ZERO, goal);
    assert!(matches!(plan, Plan::Blocked { .. }), "{plan}");
    let start = Pose2::new(0.8, 2.8, 0.0);
    let plan = cart_planner(at_home()).plan(&grid, start, Twist2::ZERO, goal);
    assert!(matches!(plan, Plan::StartInObstacle { clearance } if (clearance + 0.1).abs() < 1e-3), "{plan}");
    let plan = cart_planner(at_home()).plan(&grid, goal, Twist2::ZERO, start);
    assert!(matches!(plan, Plan::GoalInObstacle { clearance } if (clearance + 0.1).abs() < 1e-3), "{plan}");
}

/// A goal in a closed area is refused quickly, independent of the map's size for the search over headings.
#[test]
fn a_closed_room_is_detected_without_searching_all_cells() {
    let geometry = GridGeometry::new(0.05, Vector2::zeros(), 600, 600).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    for k in 400..=440 {
        for (col, row) in [(k, 400), (k, 440), (400, k), (440, k)] {
            grid.set(CellIndex { col, row }, Cell::Occupied);
        }
    }
    let (start, goal) = (Pose2::new(2.0, 2.0, 0.0), Pose2::new(21.0, 21.0, 0.0));
    let mut planner = cart_planner(at_home());
    let begin = crate::support::cpu_ms();
    let plan = planner.plan(&grid, start, Twist2::ZERO, goal);
    let spent = crate::support::cpu_ms() - begin;
    let Plan::Blocked { nearest } = plan else { panic!("{plan}") };
    assert!((nearest - goal.position()).norm() > 1.0 && nearest.x + nearest.y > 30.0, "{nearest}");
    eprintln!("a closed room: {spent:.0} ms CPU");
    assert!(spent < 1000.0, "{spent} ms");
    // With a wide enough opening, the path is found.
    (415..=425).for_each(|row| grid.set(CellIndex { col: 400, row }, Cell::Free));
    found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
}

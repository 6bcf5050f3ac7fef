//! Queries without a path as the answer.

use crate::support::{at_home, clearance, found_plan, judge, planner};
use trundle_core::{
    Cell, CellIndex, DifferentialDrive, DriveLimits, Footprint, OccupancyGrid, Pose2, Twist2, Vector2,
};
use trundle_planning::{MovingObstacle, Plan, Planner, PlannerConfig, Replan, UnknownIs, WaypointGraph};

const MAP: &str = "
    ????????????
    ?##########?
    ?#........#?
    ?#........#?
    ?#........#?
    ?#........#?
    ?##########?
    ????????????";

fn ask(config: PlannerConfig, from: (f64, f64), to: (f64, f64)) -> Plan {
    let grid = OccupancyGrid::from_ascii(0.25, MAP).unwrap();
    let pose = |p: (f64, f64)| Pose2::new(p.0, p.1, 0.0);
    planner(config, 0.17).plan(&grid, pose(from), Twist2::ZERO, pose(to))
}

#[test]
fn walls_and_borders_have_names() {
    let inside = (1.0, 1.0);
    assert!(
        matches!(ask(at_home(), (0.3, 0.3), inside), Plan::StartInObstacle { clearance } if clearance <= -0.17)
    );
    assert!(matches!(ask(at_home(), inside, (0.3, 0.3)), Plan::GoalInObstacle { .. }));
    assert!(
        matches!(ask(at_home(), inside, (0.6, 1.0)), Plan::GoalInObstacle { clearance } if (clearance + 0.07).abs() < 1e-6)
    );
    assert!(matches!(ask(at_home(), inside, (9.0, 1.0)), Plan::GoalOutside));
    assert!(matches!(ask(at_home(), (9.0, 1.0), inside), Plan::StartOutside));
    let mut walled = PlannerConfig::default();
    walled.unknown = UnknownIs::Obstacle;
    assert!(matches!(ask(walled, inside, (9.0, 1.0)), Plan::GoalOutside));
    assert!(matches!(ask(walled, inside, (2.9, 1.0)), Plan::GoalInObstacle { .. }));
    let Plan::Blocked { nearest } = ask(PlannerConfig::default(), inside, (5.0, 1.0)) else {
        panic!("no wall")
    };
    assert!(nearest.x > 2.0 && nearest.x < 2.5, "{nearest}");
    assert!(matches!(ask(PlannerConfig::default(), inside, (1e9, 1.0)), Plan::Refused(_)));
}

#[test]
fn numbers_that_are_none_are_refused_by_name() {
    for bad in [f64::NAN, f64::INFINITY] {
        let Plan::Refused(invalid) = ask(at_home(), (1.0, 1.0), (bad, 1.0)) else { panic!("{bad}") };
        assert_eq!(invalid.field, "goal x");
        assert!(matches!(ask(at_home(), (1.0, bad), (1.0, 1.0)), Plan::Refused(i) if i.field == "start y"));
    }
    let grid = OccupancyGrid::from_ascii(0.25, MAP).unwrap();
    let here = Pose2::new(1.0, 1.0, 0.0);
    let plan = planner(at_home(), 0.17).plan(&grid, here, Twist2::new(f64::NAN, 0.0), here);
    assert!(matches!(plan, Plan::Refused(i) if i.field == "start speed"));
}

#[test]
fn every_answer_is_a_sentence() {
    let sentences = [(0.3, 0.3), (0.6, 1.0), (9.0, 1.0), (f64::NAN, 1.0)]
        .map(|to| ask(at_home(), (1.0, 1.0), to).to_string());
    assert_eq!(
        sentences,
        [
            "the robot does not fit at the goal: 0.170 m of clearance are missing",
            "the robot does not fit at the goal: 0.070 m of clearance are missing",
            "the goal is off the map",
            "goal x is NaN m, expected a finite number",
        ]
    );
}

#[test]
fn staying_is_a_plan() {
    let grid = OccupancyGrid::from_ascii(0.25, MAP).unwrap();
    let here = Pose2::new(1.0, 1.0, 0.3);
    let stay = found_plan(planner(at_home(), 0.17).plan(&grid, here, Twist2::ZERO, here));
    assert_eq!((stay.trajectory.points().len(), stay.length, stay.phases.len()), (1, 0.0, 0));
    let turned = Pose2::new(1.0, 1.0, -2.0);
    let turn = found_plan(planner(at_home(), 0.17).plan(&grid, here, Twist2::ZERO, turned));
    assert!((turn.trajectory.end().theta + 2.0).abs() < 1e-9 && turn.length == 0.0);
}

#[test]
fn configurations_are_checked_by_name() {
    let mut config = PlannerConfig::default();
    config.curve.degree = 3;
    let error =
        Planner::new(config, &Footprint::KOBUKI, DriveLimits::KOBUKI, DifferentialDrive::KOBUKI).unwrap_err();
    assert_eq!(error.field, "curve.degree");
}

/// A wall below, free above.
fn beside_a_wall() -> OccupancyGrid {
    OccupancyGrid::from_ascii(0.05, &format!("{}\n{}", vec![".".repeat(60); 38].join("\n"), "#".repeat(60)))
        .unwrap()
}

#[test]
fn a_start_within_the_clearance_is_planned_out_of() {
    let grid = beside_a_wall();
    let goal = Pose2::new(2.5, 1.5, 0.0);
    for missing in [0.01, 0.03, 0.059] {
        let start = Pose2::new(0.5, 0.05 + 0.17 - missing, 0.0);
        let plan = found_plan(planner(at_home(), 0.17).plan(&grid, start, Twist2::ZERO, goal));
        // The robot never comes nearer than at the start, and is clear of the wall after leaving it.
        judge(&grid, &plan, start, goal, 0.17 - missing);
        let far = plan.trajectory.points().iter().filter(|p| p.pose.distance(&start) > missing + 0.16);
        assert!(far.map(|p| clearance(&grid, p.pose.position())).fold(9.0, f64::min) >= 0.17 - 2e-4);
    }
    for missing in [0.07, 0.15, 0.2] {
        let start = Pose2::new(0.5, 0.05 + 0.17 - missing, 0.0);
        let plan = planner(at_home(), 0.17).plan(&grid, start, Twist2::ZERO, goal);
        let Plan::StartInObstacle { clearance } = plan else { panic!("{plan}") };
        assert!((clearance + missing.min(0.17)).abs() < 1e-6, "{clearance} {missing}");
    }
}

#[test]
fn unknown_space_is_allowed_has_a_high_cost_or_is_forbidden() {
    // A known path around an unknown field: 1.4 times as long.
    let mut grid = OccupancyGrid::from_ascii(0.1, &vec![".".repeat(60); 40].join("\n")).unwrap();
    for col in 20..40 {
        (5..40).for_each(|row| grid.set(CellIndex { col, row }, Cell::Unknown));
    }
    let (start, goal) = (Pose2::new(1.0, 1.4, 0.0), Pose2::new(5.0, 1.4, 0.0));
    let ask = |unknown_weight: f64, unknown: UnknownIs| {
        let mut config = at_home();
        config.unknown = unknown;
        config.room.unknown_weight = unknown_weight;
        let plan = found_plan(planner(config, 0.17).plan(&grid, start, Twist2::ZERO, goal));
        // The path avoids costly cells; the curve may cut their corners.
        let deep =
            |at: Vector2| [at, at - Vector2::new(0.0, 0.17)].iter().all(|p| grid.at(*p) == Cell::Unknown);
        let unseen = plan.trajectory.points().iter().filter(|p| deep(p.pose.position())).count();
        (unseen, plan.length)
    };
    let (allowed, length) = ask(0.0, UnknownIs::Free);
    assert!(allowed > 0 && (length - 4.0).abs() < 0.01, "allowed: {length}");
    let (unseen, length) = ask(5.0, UnknownIs::Free);
    assert!(unseen * 4 < allowed && length > 4.3, "expensive: {unseen} of {allowed}, {length}");
    let (unseen, _) = ask(0.0, UnknownIs::Obstacle);
    assert_eq!(unseen, 0, "forbidden");
    (0..5).for_each(|row| grid.set(CellIndex { col: 30, row }, Cell::Unknown));
    let mut walled = at_home();
    walled.unknown = UnknownIs::Obstacle;
    let plan = planner(walled, 0.17).plan(&grid, start, Twist2::ZERO, goal);
    assert!(matches!(plan, Plan::Blocked { nearest } if nearest.x < 3.0), "{plan}");
}

#[test]
fn a_gap_of_one_cell_lets_through_what_fits_and_nothing_else() {
    let wall = format!("{}.{}", "#".repeat(20), "#".repeat(19));
    let open = vec![".".repeat(40); 15].join("\n");
    let grid = OccupancyGrid::from_ascii(0.1, &format!("{open}\n{wall}\n{open}")).unwrap();
    let (start, goal) = (Pose2::new(0.6, 0.5, 0.0), Pose2::new(3.4, 2.6, 1.0));
    for radius in [0.03, 0.045, 0.0499] {
        let plan = found_plan(planner(at_home(), radius).plan(&grid, start, Twist2::ZERO, goal));
        judge(&grid, &plan, start, goal, radius);
    }
    for radius in [0.0501, 0.06, 0.17] {
        let plan = planner(at_home(), radius).plan(&grid, start, Twist2::ZERO, goal);
        assert!(matches!(plan, Plan::Blocked { nearest } if nearest.y < 1.5), "{radius}: {plan}");
    }
}

#[test]
fn the_smallest_questions_have_answers() {
    let speck = OccupancyGrid::from_ascii(0.5, ".").unwrap();
    let here = Pose2::new(0.25, 0.25, 0.0);
    assert_eq!(found_plan(planner(at_home(), 0.1).plan(&speck, here, Twist2::ZERO, here)).length, 0.0);
    let hair = Pose2::new(0.2504, 0.25, 0.0);
    assert!(found_plan(planner(at_home(), 0.1).plan(&speck, here, Twist2::ZERO, hair)).length < 1e-3);
    let near = Pose2::new(0.2525, 0.25, 0.0);
    let plan = found_plan(planner(at_home(), 0.1).plan(&speck, here, Twist2::ZERO, near));
    assert!((plan.length - 0.0025).abs() < 1e-3 && plan.trajectory.end().distance(&near) < 1.1e-3);
    let wall = OccupancyGrid::from_ascii(0.5, "#").unwrap();
    let plan = planner(at_home(), 0.1).plan(&wall, here, Twist2::ZERO, here);
    assert!(matches!(plan, Plan::StartInObstacle { .. }), "{plan}");
}

#[test]
fn numbers_that_are_not_finite_are_refused_at_every_entry_point() {
    let grid = beside_a_wall();
    let (here, there) = (Pose2::new(0.5, 1.0, 0.0), Pose2::new(2.5, 1.0, 0.0));
    let nowhere = Pose2 { x: f64::NAN, ..there };
    let mut planner = planner(at_home(), 0.17);
    let first = found_plan(planner.plan(&grid, here, Twist2::ZERO, there));
    let refused = |plan: &Plan| matches!(plan, Plan::Refused(invalid) if invalid.field == "goal x");
    assert!(refused(&planner.plan_among_moving(&grid, &[], here, Twist2::ZERO, nowhere)));
    let (at, why) = planner.plan_multi_goal(&grid, here, Twist2::ZERO, &[there, nowhere]).unwrap_err();
    assert!(at == 1 && refused(&why));
    let graph = WaypointGraph::new(vec![Vector2::new(1.0, 1.0)], vec![]).unwrap();
    assert!(refused(&planner.plan_on_graph(&grid, &graph, here, Twist2::ZERO, nowhere)));
    let replan = planner.replan(&grid, &[], &first, 1.0, nowhere);
    assert!(matches!(replan, Replan::New(plan) if refused(&plan)));
    // A time that is none, or after the end, is not a panic.
    for time in [f64::NAN, -5.0, 1e9] {
        let _ = planner.validate_trajectory(&grid, &first.trajectory, time);
        let _ = planner.replan(&grid, &[], &first, time, there);
    }
    let still = MovingObstacle::new(here.position(), Vector2::zeros(), 0.3).unwrap();
    let _ = planner.plan_among_moving(&grid, &[still], here, Twist2::ZERO, there);
}

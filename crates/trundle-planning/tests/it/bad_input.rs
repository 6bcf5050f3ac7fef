//! Questions that have no way for an answer.

use crate::support::{at_home, found, planner};
use trundle_core::{DifferentialDrive, DriveLimits, Footprint, OccupancyGrid, Pose2, Twist2};
use trundle_planning::{Plan, Planner, PlannerConfig, UnknownIs};

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
    let walled = PlannerConfig { unknown: UnknownIs::Obstacle, ..PlannerConfig::default() };
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
            "the robot does not fit at the goal: 0.170 m are missing",
            "the robot does not fit at the goal: 0.070 m are missing",
            "the goal is off the map",
            "goal x is NaN m, expected a finite number",
        ]
    );
}

#[test]
fn staying_is_a_plan() {
    let grid = OccupancyGrid::from_ascii(0.25, MAP).unwrap();
    let here = Pose2::new(1.0, 1.0, 0.3);
    let stay = found(planner(at_home(), 0.17).plan(&grid, here, Twist2::ZERO, here));
    assert_eq!((stay.trajectory.points().len(), stay.length, stay.phases.len()), (1, 0.0, 0));
    let turned = Pose2::new(1.0, 1.0, -2.0);
    let turn = found(planner(at_home(), 0.17).plan(&grid, here, Twist2::ZERO, turned));
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

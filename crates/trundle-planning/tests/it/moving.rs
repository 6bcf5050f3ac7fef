//! Moving obstacles: the robot passes them or waits for them.

use crate::support::{at_home, found_plan, judge, planner};
use trundle_core::{OccupancyGrid, Pose2, Trajectory, Twist2, Vector2};
use trundle_planning::{MovingObstacle, Plan, Replan};

const RADIUS: f64 = 0.1755;
const PERSON: f64 = 0.3;

fn hall(height: usize) -> OccupancyGrid {
    let wall = "#".repeat(100);
    let floor = vec![".".repeat(100); height].join("\n");
    OccupancyGrid::from_ascii(0.1, &format!("{wall}\n{floor}\n{wall}")).unwrap()
}

fn min_gap(trajectory: &Trajectory, from: Vector2, velocity: Vector2) -> f64 {
    let gap =
        |time: f64| (trajectory.at(time).pose.position() - from - velocity * time).norm() - PERSON - RADIUS;
    (0..=2000).map(|k| gap(f64::from(k) * 1e-3)).fold(9.0, f64::min)
}

/// The minimum gap while the motion is predicted as steady, 2 s.
fn min_gap_within(trajectory: &Trajectory, from: Vector2, velocity: Vector2) -> f64 {
    let gap =
        |time: f64| (trajectory.at(time).pose.position() - from - velocity * time).norm() - PERSON - RADIUS;
    (0..=2000).map(|k| gap(f64::from(k) * 1e-3)).fold(9.0, f64::min)
}

#[test]
fn a_crossing_person_is_waited_for_or_driven_around() {
    let (start, goal) = (Pose2::new(1.0, 2.0, 0.0), Pose2::new(5.0, 2.0, 0.0));
    for (height, from, velocity) in
        [(40, (1.9, 0.6), (0.0, 0.9)), (12, (1.8, 0.3), (0.0, 0.35)), (40, (3.3, 2.0), (-0.6, 0.0))]
    {
        let grid = hall(height);
        let (start, goal) =
            if height == 12 { (Pose2::new(1.0, 0.7, 0.0), Pose2::new(5.0, 0.7, 0.0)) } else { (start, goal) };
        let (from, velocity) = (Vector2::new(from.0, from.1), Vector2::new(velocity.0, velocity.1));
        let obstacle = MovingObstacle::new(from, velocity, PERSON).unwrap();
        let mut planner = planner(at_home(), RADIUS);
        let alone = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
        assert!(min_gap(&alone.trajectory, from, velocity) < 0.0, "no encounter: {from} {velocity}");
        let plan = found_plan(planner.plan_among_moving(&grid, &[obstacle], start, Twist2::ZERO, goal));
        assert!(min_gap(&plan.trajectory, from, velocity) >= -2e-3, "{} s of wait", plan.wait);
        judge(&grid, &plan, start, goal, RADIUS);
        eprintln!("{:?}: {:.1} s of wait, {:.2} m", from.as_slice(), plan.wait, plan.length);
    }
}

/// In motion in a corridor too narrow for a detour.
#[test]
fn a_robot_that_moves_stops_for_someone_who_crosses_and_goes_on() {
    let mut grid = hall(12);
    // An opening on either side, through which a person enters and leaves.
    (0..14).filter(|row| *row == 0 || *row == 13).for_each(|row| {
        (28..36).for_each(|col| grid.set(trundle_core::CellIndex { col, row }, trundle_core::Cell::Free));
    });
    let (start, goal) = (Pose2::new(1.5, 0.7, 0.0), Pose2::new(8.0, 0.7, 0.0));
    let mut waits = 0;
    for (y, speed) in [(-0.6, 0.6), (0.0, 0.4), (-1.0, 0.9), (2.0, -0.6)] {
        let (from, velocity) = (Vector2::new(3.2, y), Vector2::new(0.0, speed));
        let obstacle = MovingObstacle::new(from, velocity, PERSON).unwrap();
        let twist = Twist2::new(0.5, 0.0);
        let mut planner = planner(at_home(), RADIUS);
        let alone = found_plan(planner.plan(&grid, start, twist, goal));
        assert!(min_gap_within(&alone.trajectory, from, velocity) < 0.0, "no encounter at {y}");
        let plan = found_plan(planner.plan_among_moving(&grid, &[obstacle], start, twist, goal));
        assert!(plan.is_continuous && plan.trajectory.points()[0].twist.v == 0.5);
        assert!(min_gap_within(&plan.trajectory, from, velocity) >= -2e-3, "{y}: {} s of wait", plan.wait);
        judge(&grid, &plan, start, goal, RADIUS);
        waits += usize::from(
            plan.trajectory.points().iter().any(|p| p.time > 0.1 && p.twist.v == 0.0 && p.pose.x < 3.0),
        );
    }
    assert!(waits >= 2, "{waits}");
}

#[test]
fn a_plan_is_kept_while_it_holds() {
    let grid = hall(40);
    let (start, goal) = (Pose2::new(1.0, 2.0, 0.0), Pose2::new(8.0, 2.5, 0.0));
    let mut planner = planner(at_home(), RADIUS);
    let first = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    assert_eq!(planner.replan(&grid, &[], &first, 3.0, goal), Replan::Keep);
    let away = MovingObstacle::new(Vector2::new(2.0, 3.5), Vector2::new(0.0, 1.0), PERSON).unwrap();
    assert_eq!(planner.replan(&grid, &[away], &first, 3.0, goal), Replan::Keep);
    let now = first.trajectory.at(3.0);
    let ahead = now.pose.position() + Vector2::new(1.4, -0.1);
    let standing = MovingObstacle::new(ahead, Vector2::zeros(), PERSON).unwrap();
    let Replan::New(Plan::Found(second)) = planner.replan(&grid, &[standing], &first, 3.0, goal) else {
        panic!("kept, or nothing")
    };
    assert!(second.is_continuous);
    let begin = second.trajectory.points()[0];
    assert!((begin.twist.v - now.twist.v).abs() < 1e-9 && (begin.twist.omega - now.twist.omega).abs() < 1e-4);
    assert!(min_gap(&second.trajectory, ahead, Vector2::zeros()) >= -1e-3);
    let other = Pose2::new(8.0, 1.0, -0.5);
    assert!(matches!(planner.replan(&grid, &[], &first, 3.0, other), Replan::New(Plan::Found(_))));
}

#[test]
fn no_mover_is_nowhere() {
    let zero = Vector2::zeros();
    assert!(MovingObstacle::new(Vector2::new(f64::NAN, 0.0), zero, 0.3).is_err());
    assert!(MovingObstacle::new(zero, Vector2::new(0.0, f64::INFINITY), 0.3).is_err());
    assert!(MovingObstacle::new(zero, zero, -0.1).is_err());
}

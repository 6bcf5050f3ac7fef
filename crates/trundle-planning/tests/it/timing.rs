//! Speed profiles: jerk, and the limit on unobserved floor.

use crate::support::{LIMITS, at_home, found_plan, judge, planner};
use trundle_core::{Cell, OccupancyGrid, Pose2, Twist2};
use trundle_planning::{PlanResult, PlannerConfig, TimingConfig};

const RADIUS: f64 = 0.1755;

fn hall() -> OccupancyGrid {
    OccupancyGrid::from_ascii(0.1, &vec![".".repeat(100); 60].join("\n")).unwrap()
}

fn gently(jerk: f64) -> PlannerConfig {
    let mut config = at_home();
    config.timing.jerk = Some(jerk);
    config
}

/// The greatest change of acceleration, from samples that are a period apart, m/s^3.
fn worst_jerk(result: &PlanResult) -> f64 {
    let points = result.trajectory.points();
    let even = |w: &&[trundle_core::TrajectoryPoint]| {
        (w[1].time - w[0].time - 0.02).abs() < 1e-6 && (w[2].time - w[1].time - 0.02).abs() < 1e-6
    };
    let jerk =
        |w: &[trundle_core::TrajectoryPoint]| (w[2].twist.v - 2.0 * w[1].twist.v + w[0].twist.v).abs() / 4e-4;
    points.windows(3).filter(even).map(jerk).fold(0.0, f64::max)
}

#[test]
fn jerk_is_bounded_where_it_is_asked_for() {
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.2), Pose2::new(8.0, 4.0, 0.8));
    let hard = found_plan(planner(at_home(), RADIUS).plan(&hall(), start, Twist2::ZERO, goal));
    assert!(worst_jerk(&hard) > 10.0, "{}", worst_jerk(&hard));
    for jerk in [1.0, 3.0] {
        let soft = found_plan(planner(gently(jerk), RADIUS).plan(&hall(), start, Twist2::ZERO, goal));
        judge(&hall(), &soft, start, goal, RADIUS);
        assert!(worst_jerk(&soft) <= jerk * 1.02, "{} of {jerk}", worst_jerk(&soft));
        let extra = soft.trajectory.duration() - hard.trajectory.duration();
        assert!(extra > 0.0 && extra < 4.0 * LIMITS.acceleration / jerk + 1.5, "{extra} s longer at {jerk}");
    }
}

#[test]
fn a_motion_under_way_goes_on_without_a_jerk() {
    let (start, goal) = (Pose2::new(1.0, 3.0, 0.0), Pose2::new(8.0, 3.4, 0.0));
    let now = Twist2::new(0.5, 0.0);
    let soft = found_plan(planner(gently(2.0), RADIUS).plan(&hall(), start, now, goal));
    assert!(soft.is_continuous);
    judge(&hall(), &soft, start, goal, RADIUS);
    assert!((soft.trajectory.points()[0].twist.v - 0.5).abs() < 1e-9);
    assert!(worst_jerk(&soft) <= 2.0 * 1.02, "{}", worst_jerk(&soft));
}

#[test]
fn unseen_floor_is_entered_slowly() {
    let mut grid = hall();
    for col in 50..100 {
        (0..60).for_each(|row| grid.set(trundle_core::CellIndex { col, row }, Cell::Unknown));
    }
    let (start, goal) = (Pose2::new(1.0, 3.0, 0.0), Pose2::new(9.0, 3.0, 0.0));
    let result = found_plan(planner(at_home(), RADIUS).plan(&grid, start, Twist2::ZERO, goal));
    let limit = TimingConfig::default().unknown_speed;
    let points = result.trajectory.points();
    assert!(points.iter().all(|p| p.pose.x < 5.0 - RADIUS + 0.01 || p.twist.v <= limit + 1e-6));
    assert!(points.iter().any(|p| p.twist.v > 0.6), "slow everywhere");
}

#[test]
fn a_speed_limit_holds_for_the_next_plans_and_never_exceeds_the_robots_own() {
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.2), Pose2::new(8.0, 4.0, 0.8));
    let mut planner = planner(at_home(), RADIUS);
    let fastest = |result: &PlanResult| {
        result.trajectory.points().iter().map(|point| point.twist.v).fold(0.0, f64::max)
    };
    let free = found_plan(planner.plan(&hall(), start, Twist2::ZERO, goal));
    planner.limit_speed(0.2);
    let slow = found_plan(planner.plan(&hall(), start, Twist2::ZERO, goal));
    judge(&hall(), &slow, start, goal, RADIUS);
    assert!(fastest(&slow) <= 0.2 + 1e-9 && fastest(&free) > 0.4, "{} {}", fastest(&slow), fastest(&free));
    // A robot that is faster than the new limit brakes.
    let moving = found_plan(planner.plan(&hall(), start, Twist2::new(0.5, 0.0), goal));
    let late = moving.trajectory.points().iter().filter(|point| point.time > 3.0);
    assert!(late.map(|point| point.twist.v).fold(0.0, f64::max) <= 0.2 + 1e-9);
    planner.limit_speed(100.0);
    let again = found_plan(planner.plan(&hall(), start, Twist2::ZERO, goal));
    assert_eq!(again.trajectory.duration(), free.trajectory.duration());
}

#[test]
fn a_limit_of_the_turn_rate_holds_for_the_next_plans_and_never_exceeds_the_robots_own() {
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.2), Pose2::new(8.0, 4.0, 2.0));
    let mut planner = planner(at_home(), RADIUS);
    let fastest = |result: &PlanResult| {
        result.trajectory.points().iter().map(|point| point.twist.omega.abs()).fold(0.0, f64::max)
    };
    let free = found_plan(planner.plan(&hall(), start, Twist2::ZERO, goal));
    planner.limit_turn_rate(0.2);
    let slow = found_plan(planner.plan(&hall(), start, Twist2::ZERO, goal));
    judge(&hall(), &slow, start, goal, RADIUS);
    // The limit holds at the nodes of the curve; between them the turn rate may be some tenths of a percent higher.
    assert!(fastest(&slow) <= 0.2 * 1.005 && fastest(&free) > 0.3, "{} {}", fastest(&slow), fastest(&free));
    planner.limit_turn_rate(100.0);
    let again = found_plan(planner.plan(&hall(), start, Twist2::ZERO, goal));
    assert_eq!(again.trajectory.duration(), free.trajectory.duration());
}

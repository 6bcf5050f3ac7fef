//! Arrivals with an uncertain pose.

use super::*;
use crate::behaviour::spin::SPIN_RATE_RAD_S;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

/// Standard deviation of the position that is too large for an exact goal \[m\].
const UNCERTAIN_M: f64 = 0.1;

/// Sets the standard deviations of the estimate, m and rad.
fn uncertain(position: f64, heading: f64) -> impl Fn(&mut WorldState<'_>) + Copy {
    let variances = Vector3::new(position * position, 1e-6, heading * heading);
    move |s| s.estimate.covariance = Matrix3::from_diagonal(&variances)
}

/// Steps until the state has one of these names, and returns it.
fn run_until(base: &mut Base, names: &[&str], change: impl Fn(&mut WorldState<'_>) + Copy) -> &'static str {
    let step = |_| {
        base.step_with(change);
        base.navigator.state().name()
    };
    (0..5000).map(step).find(|name| names.contains(name)).unwrap_or("none of these states")
}

fn kind(base: &Base) -> Option<ReasonKind> {
    match base.navigator.state() {
        DriveState::Stopped { reason } | DriveState::Recovering { reason } => Some(reason.kind()),
        _ => None,
    }
}

#[test]
fn an_uncertain_arrival_ends_the_goal_after_a_turn_on_the_spot() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    assert_eq!(run_until(&mut base, &["recovering"], uncertain(UNCERTAIN_M, 0.01)), "recovering");
    assert_eq!(kind(&base), Some(ReasonKind::ArrivalUncertain));
    let (began, heading) = (base.now, base.pose.theta);
    assert_eq!(run_until(&mut base, &["stopped", "arrived"], uncertain(UNCERTAIN_M, 0.01)), "stopped");
    assert_eq!(kind(&base), Some(ReasonKind::ArrivalUncertain));
    assert!((base.now - began) * SPIN_RATE_RAD_S >= TAU, "it turned for {} s only", base.now - began);
    assert!(base.pose.distance(&AHEAD) < 0.02 && heading.abs() < 0.1);
    let DriveState::Stopped { reason } = base.navigator.state() else { unreachable!("checked above") };
    let text = "arrived, but not sure: the position is known within 0.24 m (95 %), the goal needs 0.10 m";
    assert_eq!(reason.to_string(), text);
}

#[test]
fn an_uncertain_heading_is_no_arrival_either() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    assert_eq!(run_until(&mut base, &["stopped", "arrived"], uncertain(0.01, 0.1)), "stopped");
    let text = "arrived, but not sure: the heading is known within 11.2 deg (95 %), the goal needs 5.0 deg";
    assert_eq!(base.navigator.state().to_string(), format!("stopped: {text}"));
}

#[test]
fn a_pose_that_becomes_certain_during_the_turn_leads_to_the_goal() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    run_until(&mut base, &["recovering"], uncertain(UNCERTAIN_M, 0.01));
    let unsure = uncertain(UNCERTAIN_M, 0.01);
    for _ in 0..200 {
        base.step_with(unsure);
    }
    assert!(base.pose.theta.abs() > 1.0, "it turns");
    assert_eq!(run_until(&mut base, &["stopped", "arrived"], uncertain(0.01, 0.01)), "arrived");
    assert!(base.pose.distance(&AHEAD) < 0.01 && base.pose.theta.abs() < 0.02, "{:?}", base.pose);
}

#[test]
fn a_pose_that_is_uncertain_at_each_arrival_ends_the_goal_at_last() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    let mut turns = 0;
    while run_until(&mut base, &["recovering", "stopped", "arrived"], uncertain(UNCERTAIN_M, 0.01))
        == "recovering"
    {
        turns += 1;
        run_until(&mut base, &["driving", "final approach", "maneuvering"], uncertain(0.01, 0.01));
        assert!(turns < 5, "the robot turns without end");
    }
    assert_eq!((turns, kind(&base)), (2, Some(ReasonKind::ArrivalUncertain)));
}

#[test]
fn a_goal_with_a_wider_tolerance_needs_no_more_certainty_than_that() {
    let near = GoalOptions { tolerance: Some(0.5), ..GoalOptions::default() };
    for (heading_tolerance, end) in [(None, "arrived"), (Some(0.1), "stopped"), (Some(0.4), "arrived")] {
        let mut base = Base::new(Pose2::new(3.0, 2.0, 0.0));
        base.navigator.set_goal_with(Goal::Exact(AHEAD), GoalOptions { heading_tolerance, ..near });
        let found = run_until(&mut base, &["stopped", "arrived"], uncertain(UNCERTAIN_M, 0.15));
        assert_eq!(found, end, "{heading_tolerance:?}");
    }
}

#[test]
fn a_viewpoint_needs_no_certain_pose() {
    let mut base = Base::to(Goal::Viewpoint(AHEAD));
    assert_eq!(run_until(&mut base, &["stopped", "arrived"], uncertain(UNCERTAIN_M, 0.1)), "arrived");
}

#[test]
fn a_contradicted_pose_is_no_arrival_until_it_is_confirmed() {
    let contradicted = |s: &mut WorldState<'_>| s.pose_status.is_contradicted = true;
    let mut base = Base::to(Goal::Exact(AHEAD));
    assert_eq!(run_until(&mut base, &["stopped", "arrived"], contradicted), "stopped");
    assert_eq!(kind(&base), Some(ReasonKind::ArrivalUncertain));
    let text = base.navigator.state().to_string();
    assert!(
        text.starts_with("stopped: arrived, but not sure: two scans contradicted the odometry"),
        "{text}"
    );

    let mut base = Base::to(Goal::Exact(AHEAD));
    assert_eq!(run_until(&mut base, &["recovering"], contradicted), "recovering");
    assert_eq!(run_until(&mut base, &["stopped", "arrived"], |_| ()), "arrived");
}

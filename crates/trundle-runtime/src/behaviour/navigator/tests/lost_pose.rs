//! A pose that is lost and found again: the robot drives nowhere without it, and reaches its goal with it.

use super::*;

/// A position known within 2 m: too uncertain to drive.
fn lose(s: &mut WorldState<'_>) {
    s.estimate.covariance = nalgebra::Matrix3::from_diagonal_element(4.0);
}

/// Steps without a pose for `seconds`; the twists.
fn without_pose(base: &mut Base, seconds: f64) -> Vec<Twist2> {
    let steps = (seconds / STEP_S).round() as usize;
    (0..steps).map(|_| base.step_with(lose).twist).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10))]

    /// However early and long the pose is lost, the robot only brakes and turns without it, and arrives with it.
    #[test]
    fn a_lost_pose_delays_the_goal_and_does_not_end_it(before in 0.0..5.0_f64, lost in 0.1..12.0_f64, again in 0.0..2.0_f64) {
        let mut base = Base::to(Goal::Exact(AHEAD));
        for (known, unknown) in [(before, lost), (again, 0.5 * lost)] {
            base.run(known);
            if base.navigator.state().is_over() {
                break;
            }
            let speed = base.twist.v;
            let twists = without_pose(&mut base, unknown);
            let limit = DriveLimits::KOBUKI.acceleration * STEP_S;
            let braking = (speed / limit).ceil() as usize + 1;
            prop_assert!(twists.windows(2).all(|pair| pair[1].v <= pair[0].v + 1e-9), "it speeds up without a pose");
            prop_assert!(twists.iter().skip(braking).all(|twist| twist.v == 0.0), "it drives without a pose");
            prop_assert_eq!(base.navigator.state().name(), "lost");
        }
        prop_assert!(base.navigator.state().is_over() || base.run_to("arrived").is_some(), "{}", base.navigator.state());
        prop_assert!(base.pose.distance(&AHEAD) < 0.03, "{:?}", base.pose);
    }
}

/// A pose that is lost in any state with a goal leads to the same state, and its return to a new plan.
#[test]
fn each_state_with_a_goal_gives_way_to_the_search_of_the_pose() {
    let states = [
        State::Plan(PathSearch::default()),
        State::Drive(Drive::default()),
        State::Approach,
        State::Maneuver,
        waiting(Reason::MovingObstacle, Some(Stamp::default())),
        waiting(Reason::PathOutOfView, None),
    ];
    for state in states {
        let mut base = Base::to(Goal::Exact(AHEAD));
        base.run(2.0);
        base.navigator.machine.place(state.clone());
        base.step_with(lose);
        let DriveState::Lost { reason } = base.navigator.state() else {
            panic!("{state:?}: {}", base.navigator.state())
        };
        assert_eq!(reason.kind(), ReasonKind::PoseUncertain, "{state:?}");
        base.step_with(|_| ());
        assert!(!matches!(base.navigator.state(), DriveState::Lost { .. }), "{state:?}");
        assert!(base.run_to("arrived").is_some(), "{state:?}: {}", base.navigator.state());
    }
}

/// A robot without a goal, or with an ended one, has no use for its pose: it stays at rest.
#[test]
fn without_a_goal_a_lost_pose_moves_nothing() {
    let mut idle = Base::new(Pose2::new(3.0, 2.0, 0.0));
    assert!(without_pose(&mut idle, 3.0).iter().all(|twist| *twist == Twist2::ZERO));
    assert_eq!(idle.navigator.state(), DriveState::Idle);
    let mut done = Base::to(Goal::Exact(Pose2::new(3.4, 2.0, 0.0)));
    done.run_to("arrived").unwrap();
    done.run(0.1);
    assert!(without_pose(&mut done, 3.0).iter().all(|twist| *twist == Twist2::ZERO));
    assert_eq!(done.navigator.state(), DriveState::Arrived);
}

/// The search of the pose is under the safety monitor, as each motion.
#[test]
fn the_search_of_the_pose_stops_for_a_hold_of_the_body() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    base.run(3.0);
    assert!(without_pose(&mut base, 3.0).last().unwrap().omega > 0.1);
    for _ in 0..20 {
        let held = base.step_with(|s| {
            lose(s);
            s.hold = Some(trundle_control::MotionHold::OverCurrent);
        });
        assert_eq!(held.twist, Twist2::ZERO);
    }
    assert!(without_pose(&mut base, 1.0).last().unwrap().omega > 0.1, "it turns on after the hold");
}

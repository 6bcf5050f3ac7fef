//! Goals without a path.

use super::*;

#[test]
fn a_wall_across_the_room_is_waited_for_and_driven_through_once_it_is_gone() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    base.wall(Cell::Occupied);
    base.run_to("recovering").unwrap();
    assert_eq!(base.navigator.state().reason().unwrap().kind(), ReasonKind::PathBlocked);
    base.run_to("waiting").unwrap();
    assert_eq!(base.navigator.state().reason().unwrap().kind(), ReasonKind::PathBlocked);
    assert!(base.pose.x < 3.9, "{:?}", base.pose);
    base.wall(Cell::Free);
    assert!(base.run_to("arrived").is_some(), "{}", base.navigator.state());
}

#[test]
fn a_viewpoint_without_a_path_is_given_up_at_once_and_a_goal_is_not() {
    for (goal, name) in [(Goal::Viewpoint(AHEAD), "stopped"), (Goal::Exact(AHEAD), "recovering")] {
        let mut base = Base::to(goal);
        base.wall(Cell::Occupied);
        base.run(settings().opening + 0.5);
        assert_eq!(base.navigator.state().name(), name, "{goal:?}");
        assert!(base.navigator.state().reason().unwrap().is_due_to(ReasonKind::PathBlocked));
        assert!(base.navigator.plan().is_none());
    }
}

#[test]
fn a_goal_that_does_not_wait_ends_once_no_plan_finds_a_path_to_it() {
    let in_the_wall = Pose2::new(5.95, 2.0, 0.0);
    for (goal, kind) in [(AHEAD, ReasonKind::PathBlocked), (in_the_wall, ReasonKind::TooLittleRoom)] {
        let mut base = Base::to(Goal::Exact(goal));
        base.navigator.end_without_path(true);
        if goal == AHEAD {
            base.wall(Cell::Occupied);
        }
        let opening = settings().opening;
        let seconds = base.run_to("stopped").unwrap() as f64 * STEP_S;
        assert!((opening + 2.0..opening + 2.5).contains(&seconds), "{seconds} s");
        assert_eq!(base.navigator.state().reason().unwrap().kind(), kind);
        base.run(1.0);
        assert_eq!(base.twist, Twist2::ZERO);
    }
}

#[test]
fn a_wall_of_one_second_ends_no_goal() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    base.navigator.end_without_path(true);
    base.wall(Cell::Occupied);
    base.run(settings().opening + 1.0);
    assert_eq!(base.navigator.state().name(), "recovering");
    base.wall(Cell::Free);
    assert!(base.run_to("arrived").is_some(), "{}", base.navigator.state());
}

#[test]
fn a_goal_in_a_wall_is_refused_with_that_reason() {
    let mut base = Base::to(Goal::Viewpoint(Pose2::new(5.95, 2.0, 0.0)));
    base.run_to("stopped").unwrap();
    assert_eq!(base.navigator.state().reason().unwrap().kind(), ReasonKind::TooLittleRoom);
}

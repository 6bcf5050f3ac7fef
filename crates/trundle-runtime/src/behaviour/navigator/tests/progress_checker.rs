//! Progress towards a goal: patience, detours and waits, and goals with a tolerance.

use super::*;
use crate::mission::{GoalOptions, WhenBlocked};

/// A wall across the room at x = 4 m with a door at y = 1.5 to 2.5 m, and a gap at its lower end for a detour.
fn room_with_a_door(has_detour: bool) -> Base {
    let mut base = Base::new(Pose2::new(3.0, 2.0, 0.0));
    base.wall(Cell::Occupied);
    door(&mut base, Cell::Free);
    if has_detour {
        (1..18).for_each(|row| base.grid.set(CellIndex { col: 80, row }, Cell::Free));
    }
    base
}

/// Opens or closes the door.
fn door(base: &mut Base, cell: Cell) {
    (30..50).for_each(|row| base.grid.set(CellIndex { col: 80, row }, cell));
}

fn options(when_blocked: WhenBlocked) -> GoalOptions {
    GoalOptions { when_blocked: Some(when_blocked), patience: Some(20.0), ..GoalOptions::default() }
}

#[test]
fn a_door_that_closes_ends_the_goal_within_the_patience() {
    let mut base = room_with_a_door(false);
    base.navigator.set_goal_with(Goal::Exact(AHEAD), options(WhenBlocked::Detour));
    base.run_to("driving").unwrap();
    base.run(0.5);
    door(&mut base, Cell::Occupied);
    let seconds = base.run_to("stopped").unwrap() as f64 * STEP_S;
    assert!((19.0..21.5).contains(&seconds), "{seconds} s");
    let reason = base.navigator.state().reason().unwrap().clone();
    assert!(
        reason.is_due_to(ReasonKind::NoProgress) && reason.is_due_to(ReasonKind::PathBlocked),
        "{reason}"
    );
}

#[test]
fn a_door_that_opens_and_closes_again_and_again_ends_the_goal_too() {
    let mut base = room_with_a_door(false);
    base.navigator.set_goal_with(Goal::Exact(AHEAD), options(WhenBlocked::Detour));
    let mut seconds = 0.0;
    while !base.navigator.state().is_over() && seconds < 300.0 {
        // The door closes before the robot, and opens behind it.
        if base.pose.x > 3.5 {
            door(&mut base, Cell::Occupied);
        } else if base.pose.x < 3.4 {
            door(&mut base, Cell::Free);
        }
        base.run(0.1);
        seconds += 0.1;
    }
    assert_eq!(base.navigator.state().name(), "stopped", "{}", base.navigator.state());
    assert!(seconds < 100.0, "{seconds} s");
}

#[test]
fn a_goal_that_asks_to_wait_is_never_given_up_before_a_closed_door() {
    let mut base = room_with_a_door(false);
    base.navigator.set_goal_with(Goal::Exact(AHEAD), options(WhenBlocked::Wait));
    base.navigator.end_without_path(true);
    base.run_to("driving").unwrap();
    base.run(0.5);
    door(&mut base, Cell::Occupied);
    base.run(120.0);
    assert_eq!(base.navigator.state().name(), "waiting", "{}", base.navigator.state());
    door(&mut base, Cell::Free);
    assert!(base.run_to("arrived").is_some(), "{}", base.navigator.state());
}

#[test]
fn before_a_closed_door_the_robot_takes_a_long_detour_or_waits_as_the_goal_asks() {
    for (when_blocked, detours) in [(WhenBlocked::Detour, true), (WhenBlocked::Wait, false)] {
        let mut base = room_with_a_door(true);
        base.pose.y = 2.5;
        let goal = Pose2::new(4.8, 2.5, 0.0);
        base.navigator.set_goal_with(Goal::Exact(goal), options(when_blocked));
        base.run_to("driving").unwrap();
        base.run(0.5);
        door(&mut base, Cell::Occupied);
        let mut lowest = base.pose.y;
        for _ in 0..1500 {
            base.run(STEP_S);
            lowest = lowest.min(base.pose.y);
        }
        let name = base.navigator.state().name();
        assert_eq!(
            (lowest < 1.0, name == "arrived"),
            (detours, detours),
            "{when_blocked:?}: {lowest} m, {name}"
        );
        if !detours {
            let kind = base.navigator.state().reason().unwrap().kind();
            assert_eq!(kind, ReasonKind::PathBlocked, "{}", base.navigator.state());
            door(&mut base, Cell::Free);
            assert!(base.run_to("arrived").is_some());
        }
    }
}

#[test]
fn a_detour_takes_as_long_as_it_takes() {
    let mut base = room_with_a_door(true);
    let patience = GoalOptions { patience: Some(4.0), ..options(WhenBlocked::Detour) };
    base.navigator.set_goal_with(Goal::Exact(AHEAD), patience);
    base.run_to("driving").unwrap();
    base.run(0.8);
    door(&mut base, Cell::Occupied);
    assert!(base.run_to("arrived").is_some(), "{}", base.navigator.state());
}

#[test]
fn a_goal_with_a_tolerance_ends_without_settling_and_a_blocked_one_beside_the_obstacle() {
    let near =
        |heading| GoalOptions { tolerance: Some(0.5), heading_tolerance: heading, ..GoalOptions::default() };
    for heading in [None, Some(0.2)] {
        let goal = Pose2::new(4.2, 2.6, 2.0);
        let mut exact = Base::to(Goal::Exact(goal));
        let steps = exact.run_to("arrived").unwrap();
        let mut base = Base::new(Pose2::new(3.0, 2.0, 0.0));
        base.navigator.set_goal_with(Goal::Exact(goal), near(heading));
        assert!(base.run_to("arrived").unwrap() <= steps);
        assert!(base.pose.distance(&goal) < 0.5);
        // A box stands on the goal.
        let mut base = Base::new(Pose2::new(3.0, 2.0, 0.0));
        (50..54)
            .for_each(|row| (82..86).for_each(|col| base.grid.set(CellIndex { col, row }, Cell::Occupied)));
        base.navigator.set_goal_with(Goal::Exact(goal), near(heading));
        assert!(base.run_to("arrived").is_some(), "{}", base.navigator.state());
        assert!((0.2..0.5).contains(&base.pose.distance(&goal)), "{:?}", base.pose);
        let off = trundle_core::difference_of_angles(base.pose.theta, goal.theta).abs();
        assert!(heading.is_none_or(|max| off < max), "{off} rad");
    }
}

#[test]
fn a_goal_keeps_its_own_patience_when_the_robots_changes() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    let own = GoalOptions { patience: Some(6.0), ..GoalOptions::default() };
    // The opening does not count.
    let opening = settings().opening;
    for (options, expected) in [(GoalOptions::default(), opening + 3.0), (own, 6.0)] {
        base.navigator.set_goal_with(Goal::Exact(AHEAD), options);
        base.navigator.change(RunSetting::Patience(3.0));
        let steps = (0..1000).take_while(|_| {
            base.step_with(|s| s.scan = None);
            !base.navigator.state().is_over()
        });
        let seconds = steps.count() as f64 * STEP_S;
        assert!((seconds - expected).abs() < 0.2, "{seconds} s, not {expected}");
        base.navigator.change(RunSetting::Patience(75.0));
    }
}

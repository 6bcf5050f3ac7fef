//! Loss of the view during a wait, and the turns that restore it.

use super::*;

/// Time without sight \[s\].
const BLIND_S: f64 = 5.0;

/// Makes the robot wait without a usable scan, turn, and regain a scan; returns the stamp of that scan.
fn lose_sight_and_find_it(navigator: &mut Navigator, grid: &OccupancyGrid, from: Stamp) -> Stamp {
    let mut times = StageTimes::default();
    let mut pose = Pose2::new(3.0, 2.0, 0.0);
    let reason = Reason::Safety(StopReason::StaleImage { age: 1.0 });
    navigator.machine.place(waiting(reason, Some(from)));
    for i in 1..=(BLIND_S / STEP_S) as i32 {
        let now = from.after(STEP_S * f64::from(i));
        let s = WorldState { seen: Some(from.after(-1.0)), ..at_rest(grid, now, pose) };
        let twist = navigator.step(&s, &mut times).twist;
        pose = pose.advance(twist, STEP_S);
    }
    assert!(pose.theta > 0.5, "it turns to find its sight: {}", pose.theta);
    let sees = |after: f64| from.after(BLIND_S + after);
    for now in (1..50).map(|i| sees(STEP_S * f64::from(i))) {
        if !navigator.state().is_over() {
            navigator.machine.place(waiting(Reason::PathOutOfView, Some(from)));
        }
        navigator.step(&WorldState { seen: Some(now), ..at_rest(grid, now, pose) }, &mut times);
    }
    sees(1.0)
}

#[test]
fn it_turns_only_after_it_has_seen_nothing_for_a_while_however_long_it_was_held() {
    let (grid, mut navigator, pose) = (floor(|_| false), navigator(), Pose2::new(3.0, 2.0, 0.0));
    navigator.set_goal(Goal::Viewpoint(Pose2::new(4.0, 2.0, 0.0)));
    let (held, mut times) = (Stamp::default().after(10.0), StageTimes::default());
    let seen = held.after(20.0);
    for (blind, turns) in [(1.0, false), (2.9, false), (3.1, true)] {
        navigator.machine.place(waiting(Reason::MovingObstacle, Some(held)));
        let s = WorldState { seen: Some(seen), ..at_rest(&grid, seen.after(blind), pose) };
        let twist = navigator.step(&s, &mut times).twist;
        assert_eq!(twist.omega != 0.0, turns, "blind for {blind} s: {twist:?}");
    }
}

#[test]
fn a_viewpoint_is_given_up_when_the_camera_goes_blind_twice_on_its_path_and_a_goal_is_not() {
    let (grid, ahead) = (floor(|_| false), Pose2::new(4.0, 2.0, 0.0));
    for (goal, given_up) in [(Goal::Viewpoint(ahead), true), (Goal::Exact(ahead), false)] {
        let mut navigator = navigator();
        navigator.set_goal(goal);
        let once = lose_sight_and_find_it(&mut navigator, &grid, Stamp::default().after(10.0));
        assert!(!navigator.state().is_over(), "the camera may have failed: {:?}", navigator.state());
        let twice = lose_sight_and_find_it(&mut navigator, &grid, once);
        assert_eq!(navigator.state().is_over(), given_up, "{goal:?}: {:?}", navigator.state());
        // A new goal restarts the count.
        navigator.set_goal(goal);
        lose_sight_and_find_it(&mut navigator, &grid, twice);
        assert!(!navigator.state().is_over(), "{:?}", navigator.state());
    }
}

//! Unseen floor on the path: the viewpoints, and the end without a path.

use super::*;
use crate::behaviour::path_search::viewpoint::{ViewTarget, Viewpoint};
use crate::behaviour::progress_checker::guard::MIN_FINAL_OBSERVATION_S;
use trundle_planning::Plan;

/// A lane along x whose bend into a side lane along y, at x from 2.6 to 3.2 m, was never seen.
pub(super) fn unseen_bend() -> OccupancyGrid {
    let mut grid = floor(|at| at.y > 1.4 && at.y < 2.2);
    let geometry = *grid.geometry();
    for k in 0..geometry.len() {
        let at = geometry.center(geometry.cell(k));
        let is_lane = (0.8..1.4).contains(&at.y) && (0.3..3.2).contains(&at.x);
        let is_side_lane = (2.6..3.2).contains(&at.x) && (0.8..3.7).contains(&at.y);
        if !is_lane && !is_side_lane {
            grid.set(geometry.cell(k), Cell::Occupied);
        }
    }
    grid
}

#[test]
fn where_no_path_shows_the_floor_in_time_it_is_observed_first_and_never_driven_on_unseen() {
    let (grid, mut navigator) = (unseen_bend(), navigator());
    let goal = Pose2::new(2.9, 3.2, 1.57);
    let mut pose = Pose2::new(2.6, 1.1, 0.0);
    // The floor remains unseen: every observation is without result. The goal ends after the patience and the last look, and the reason is reported.
    navigator.set_goal(Goal::Exact(goal));
    navigator.machine.place(State::Plan(PathSearch::default()));
    let (mut looks, mut seconds) = (0, 0.0);
    while !navigator.state().is_over() && seconds < 600.0 {
        seconds += 0.2;
        let s = at_rest(&grid, Stamp::default().after(seconds), pose);
        let s = WorldState { seen: Some(s.now), ..s };
        navigator.prepare(&s);
        navigator.machine.plan(&mut navigator.tools, &s, &mut StageTimes::default());
        assert!(navigator.plan().is_none(), "no way is driven that leads there");
        if let Some(end) = navigator.tools.follower.end() {
            // The simulated robot moves to the end of its path in one step.
            pose = end;
            navigator.tools.follower.halt();
            let State::Recover(recover) = navigator.machine.state_mut() else {
                panic!("a drive to a viewpoint")
            };
            recover.search.viewpoint = Viewpoint::Settled;
            looks += 1;
            let (view, at) =
                (navigator.tools.planner.camera_fov.unwrap(), recover.search.blocked_at.unwrap());
            assert!(view.shows(&grid, pose, at));
            assert_eq!(grid.at(at), Cell::Unknown);
        }
    }
    let patience = settings().patience;
    assert!(
        looks > 1 && (patience..patience + MIN_FINAL_OBSERVATION_S + 5.0).contains(&seconds),
        "{looks} looks, {seconds} s"
    );
    let reason = navigator.state().reason().unwrap().to_string();
    assert!(reason.contains("no free path") && reason.contains("could not be observed"), "{reason}");
}

#[test]
fn the_path_to_a_viewpoint_ends_where_it_is_blocked_or_leads_onto_unseen_floor() {
    let ends_on = |floor_by_now: &OccupancyGrid| {
        let (grid, mut navigator) = (floor(|_| false), navigator());
        let (from, place) = (Pose2::new(1.0, 2.0, 0.0), Pose2::new(4.0, 2.0, 0.0));
        let (planner, follower) = (&mut navigator.tools.planner, &mut navigator.tools.follower);
        let Plan::Found(plan) = planner.planner.plan(&grid, from, Twist2::ZERO, place) else {
            panic!("nothing is in the way")
        };
        follower.follow(plan.trajectory.clone(), place);
        let viewpoint = Viewpoint::Going(ViewTarget::UnknownFloor, plan.trajectory);
        let mut search = PathSearch { viewpoint, ..PathSearch::default() };
        let s = at_rest(floor_by_now, Stamp::default(), from);
        follower.step(&s.estimate, s.now);
        search.watch_path_to_viewpoint(planner, follower, &s);
        let halts = follower.reference().is_none();
        assert_eq!(halts, matches!(search.viewpoint, Viewpoint::Looking(_)));
        halts
    };
    assert!(!ends_on(&floor(|_| false)), "all is as it was");
    assert!(!ends_on(&floor(|at| at.x > 5.0)), "unseen beyond the place");
    // A chair that hides its own side: the camera does not observe the floor to the side of the robot.
    assert!(ends_on(&floor(|at| at.x < 1.6 && at.y > 2.05)));
    let mut blocked = floor(|_| false);
    (0..80).for_each(|row| blocked.set(CellIndex { col: 50, row }, Cell::Occupied));
    assert!(ends_on(&blocked));
}

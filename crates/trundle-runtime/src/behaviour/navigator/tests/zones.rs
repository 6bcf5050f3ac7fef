//! Zones in the navigator: speed limits, costs, and plans that were made before the zones changed.

use super::*;
use crate::zones::{RobotZones, ZonedMap};
use trundle_core::{MapAnnotations, Zone, ZoneKind};

const START: Pose2 = Pose2 { x: 1.0, y: 2.0, theta: 0.0 };
const GOAL: Pose2 = Pose2 { x: 5.0, y: 2.0, theta: 0.0 };

/// A zone from x 2.5 to 3.5 m, and y 1 to 3 m.
fn zones(grid: &OccupancyGrid, kind: ZoneKind, pose: Pose2) -> RobotZones {
    let outline = vec![[2.5, 1.0], [3.5, 1.0], [3.5, 3.0], [2.5, 3.0]];
    let zone = Zone { id: 1, name: "rug".to_owned(), kind, outline };
    let mut zones = RobotZones::new(&Footprint::KOBUKI, 0.06);
    zones.set(MapAnnotations { zones: vec![zone], places: vec![] });
    zones.update(pose, &ZonedMap { grid, revision: 1, static_grid: None, scanned: None });
    zones
}

/// A navigator that drives to a goal, after its first plan.
fn sent_to(goal: Pose2, s: &WorldState<'_>) -> Navigator {
    let mut navigator = navigator();
    navigator.set_goal(Goal::Exact(goal));
    navigator.machine.place(State::Plan(PathSearch::default()));
    navigator.prepare(s);
    navigator.machine.plan(&mut navigator.tools, s, &mut StageTimes::default());
    navigator
}

#[test]
fn a_plan_leads_around_a_no_go_zone_and_slowly_through_a_slow_one() {
    let grid = floor(|_| false);
    let direct = sent_to(GOAL, &at_rest(&grid, Stamp::default(), START)).tools.plan.unwrap().result;
    let no_go = zones(&grid, ZoneKind::NoGo, START);
    let s = WorldState { zones: no_go.view(), ..at_rest(&grid, Stamp::default(), START) };
    let around = sent_to(GOAL, &s).tools.plan.unwrap().result;
    let inside = |pose: Pose2| (2.4..3.6).contains(&pose.x) && (0.9..3.1).contains(&pose.y);
    assert!(direct.trajectory.points().iter().any(|point| inside(point.pose)));
    assert!(around.trajectory.points().iter().all(|point| !inside(point.pose)));
    let slow = zones(&grid, ZoneKind::Slow(0.1), START);
    let s = WorldState { zones: slow.view(), ..at_rest(&grid, Stamp::default(), START) };
    let slowly = sent_to(GOAL, &s).tools.plan.unwrap().result;
    let points = slowly.trajectory.points().iter().filter(|point| inside(point.pose));
    let speeds: Vec<f64> = points.filter(|p| (2.55..3.45).contains(&p.pose.x)).map(|p| p.twist.v).collect();
    assert!(!speeds.is_empty() && speeds.iter().all(|v| *v < 0.11), "{speeds:?}");
    assert!(slowly.length < around.length);
}

#[test]
fn a_goal_in_a_no_go_zone_is_refused_by_its_name_also_from_inside() {
    let grid = floor(|_| false);
    for start in [START, Pose2::new(3.0, 2.0, 0.0)] {
        let zones = zones(&grid, ZoneKind::NoGo, start);
        let s = WorldState { zones: zones.view(), ..at_rest(&grid, Stamp::default(), start) };
        let navigator = sent_to(Pose2::new(3.2, 2.2, 0.0), &s);
        assert!(navigator.plan().is_none());
        let reason = navigator.state().reason().unwrap().to_string();
        assert!(reason.contains("the goal is in the no-go zone 'rug'"), "{reason}");
    }
    let zones = zones(&grid, ZoneKind::NoGo, Pose2::new(3.0, 2.0, 0.0));
    let inside = at_rest(&grid, Stamp::default(), Pose2::new(3.0, 2.0, 0.0));
    let out =
        sent_to(GOAL, &WorldState { zones: zones.view(), ..inside }).tools.plan.expect("a way out").result;
    let first = out.trajectory.points().iter().filter(|point| point.pose.x < 3.4);
    assert!(first.clone().count() > 1 && first.clone().all(|point| point.twist.v < 0.16));
}

#[test]
fn a_plan_made_after_the_zones_changed_is_not_rejected_for_them() {
    let grid = floor(|_| false);
    let mut navigator = sent_to(GOAL, &at_rest(&grid, Stamp::default(), START));
    navigator.machine.place(waiting(Reason::MovingObstacle, None));
    let zones = zones(&grid, ZoneKind::NoGo, START);
    let replans = |after: f64, navigator: &mut Navigator| {
        let now = Stamp::default().after(after);
        let s = WorldState { zones: zones.view(), seen: Some(now), ..at_rest(&grid, now, START) };
        navigator.step(&s, &mut StageTimes::default()).replanned
    };
    assert!(replans(0.02, &mut navigator), "the wait ends with a plan around the zone");
    assert!(!replans(0.3, &mut navigator), "this plan respects the zone");
}

#[test]
fn a_zone_on_the_path_ends_the_plan_and_the_next_one_goes_around() {
    let grid = floor(|_| false);
    let s = at_rest(&grid, Stamp::default(), START);
    let mut navigator = sent_to(GOAL, &s);
    assert_eq!(navigator.state(), DriveState::Driving);
    let zones = zones(&grid, ZoneKind::NoGo, START);
    let s = WorldState { zones: zones.view(), ..at_rest(&grid, Stamp::default().after(0.02), START) };
    assert!(navigator.may_take_long(&s));
    let decision = navigator.step(&s, &mut StageTimes::default());
    assert!(decision.replanned && !navigator.tools.planner.has_other_zones(&s));
}

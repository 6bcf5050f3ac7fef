//! Masks, several goals, lanes, goals nearby.

use crate::support::{at_home, found_plan, judge, min_clearance, planner};
use trundle_core::{Cell, GridGeometry, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::{CostMask, Plan, PlanResult, PlannerConfig, Replan, SpeedMask, WaypointGraph};

const RADIUS: f64 = 0.1755;

fn hall() -> OccupancyGrid {
    OccupancyGrid::from_ascii(0.1, &vec![".".repeat(100); 60].join("\n")).unwrap()
}

#[test]
fn keep_out_zones_are_kept() {
    let grid = hall();
    let (start, goal) = (Pose2::new(1.0, 3.0, 0.0), Pose2::new(9.0, 3.0, 0.0));
    // Another resolution, and only a part of the hall.
    let geometry = GridGeometry::new(0.25, Vector2::new(4.0, 2.0), 8, 8).unwrap();
    let mask = OccupancyGrid::filled(geometry, Cell::Occupied);
    let mut planner = planner(at_home(), RADIUS);
    planner.set_keep_out(Some(mask));
    let around = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    assert!(around.length > 8.2);
    let outside = |p: Vector2| (p - p.sup(&Vector2::new(4.0, 2.0)).inf(&Vector2::new(6.0, 4.0))).norm();
    let nearest = around.trajectory.points().iter().map(|p| outside(p.pose.position())).fold(9.0, f64::min);
    assert!(nearest >= RADIUS - 1e-3, "{nearest}");
    let within = planner.plan(&grid, start, Twist2::ZERO, Pose2::new(5.0, 3.0, 0.0));
    assert!(matches!(within, Plan::GoalInObstacle { .. }), "{within}");
    planner.set_keep_out(None);
    let straight = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    assert!((straight.length - 8.0).abs() < 1e-3);
}

#[test]
fn a_plan_is_no_longer_free_where_a_mask_forbids_it_since() {
    let grid = hall();
    let (start, goal) = (Pose2::new(1.0, 3.0, 0.0), Pose2::new(9.0, 3.0, 0.0));
    let mut planner = planner(at_home(), RADIUS);
    let plan = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    let strip = OccupancyGrid::filled(
        GridGeometry::new(0.03, Vector2::new(5.0, 2.0), 1, 60).unwrap(),
        Cell::Occupied,
    );
    planner.set_keep_out(Some(strip.clone()));
    let hit = planner.validate_trajectory(&grid, &plan.trajectory, 0.0).unwrap_err();
    assert!((hit.pose.x - (5.0 - RADIUS)).abs() < 0.02, "{hit}");
    let Replan::New(Plan::Found(around)) = planner.replan(&grid, &[], &plan, 2.0, goal) else {
        panic!("kept")
    };
    assert!(around.is_continuous && planner.validate_trajectory(&grid, &around.trajectory, 0.0).is_ok());
    planner.set_keep_out(None);
    assert!(planner.validate_trajectory(&grid, &plan.trajectory, 0.0).is_ok());
    // The same mask in another frame has no overlap and forbids no cell.
    let elsewhere = GridGeometry::new(0.03, Vector2::new(500.0, -80.0), 9, 9).unwrap();
    planner.set_keep_out(Some(OccupancyGrid::filled(elsewhere, Cell::Occupied)));
    assert_eq!(planner.replan(&grid, &[], &plan, 2.0, goal), Replan::Keep);
    assert_eq!(found_plan(planner.plan(&grid, start, Twist2::ZERO, goal)).trajectory, plan.trajectory);
}

#[test]
fn a_mask_holds_beside_the_map_too() {
    let open = ".".repeat(40);
    let barred = format!("{}#{}", ".".repeat(20), ".".repeat(19));
    let art = format!("{open}\n{open}\n{barred}\n{open}\n{open}");
    let mut grid = OccupancyGrid::from_ascii(0.1, &art).unwrap();
    (0..5).for_each(|row| grid.set(trundle_core::CellIndex { col: 20, row }, Cell::Occupied));
    let (start, goal) = (Pose2::new(0.5, 0.25, 0.0), Pose2::new(3.5, 0.25, 0.0));
    let mut planner = planner(PlannerConfig::default(), RADIUS);
    let over = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    assert!(over.trajectory.points().iter().any(|p| !(0.0..0.5).contains(&p.pose.y)), "beside the map");
    let above = GridGeometry::new(0.1, Vector2::new(1.0, 0.5), 20, 20).unwrap();
    planner.set_keep_out(Some(OccupancyGrid::filled(above, Cell::Occupied)));
    let below = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    assert!(
        below
            .trajectory
            .points()
            .iter()
            .all(|p| !(1.0..3.0).contains(&p.pose.x) || p.pose.y < 0.5 - RADIUS + 1e-3)
    );
}

#[test]
fn the_speed_mask_is_obeyed() {
    let geometry = GridGeometry::new(0.5, Vector2::new(4.0, 0.0), 4, 12).unwrap();
    let mask = SpeedMask::new(geometry, vec![0.2; geometry.len()]).unwrap();
    let (start, goal) = (Pose2::new(1.0, 3.0, 0.0), Pose2::new(9.0, 3.0, 0.0));
    let mut planner = planner(at_home(), RADIUS);
    planner.set_speed_mask(Some(mask));
    let result = found_plan(planner.plan(&hall(), start, Twist2::ZERO, goal));
    for point in result.trajectory.points() {
        let slow = (4.0..6.0).contains(&point.pose.x);
        assert!(!slow || point.twist.v <= 0.2 + 1e-6, "{point:?}");
    }
    assert!(result.trajectory.points().iter().any(|p| p.pose.x > 6.5 && p.twist.v > 0.6));
    judge(&hall(), &result, start, goal, RADIUS);
}

#[test]
fn a_tour_rests_at_each_goal() {
    let goals = [
        Pose2::new(4.0, 1.0, 1.5),
        Pose2::new(4.0, 5.0, 3.0),
        Pose2::new(4.0, 5.0, 0.0),
        Pose2::new(8.0, 3.0, 0.0),
    ];
    let start = Pose2::new(1.0, 1.0, 0.0);
    let mut planner = planner(at_home(), RADIUS);
    let plan = planner.plan_multi_goal(&hall(), start, Twist2::ZERO, &goals).unwrap();
    assert_eq!(plan.legs.len(), 4);
    let mut from = start;
    let mut time = 0.0;
    for (leg, goal) in plan.legs.iter().zip(goals) {
        judge(&hall(), leg, from, goal, RADIUS);
        (from, time) = (leg.trajectory.end(), time + leg.trajectory.duration());
        let there = plan.trajectory.at(time);
        assert!(there.pose.distance(&goal) < 1.1e-3 && there.twist.v.abs() < 1e-6, "{there:?}");
    }
    assert!((plan.trajectory.duration() - time).abs() < 1e-9);
    let (at, why) = planner
        .plan_multi_goal(&hall(), start, Twist2::ZERO, &[goals[0], Pose2::new(99.0, 0.0, 0.0)])
        .unwrap_err();
    assert!(at == 1 && why == Plan::GoalOutside, "{at} {why}");
    assert!(planner.plan_multi_goal(&hall(), start, Twist2::ZERO, &[]).is_err());
}

#[test]
fn lanes_are_kept_to_and_blocked_ones_avoided() {
    let at = |x: f64, y: f64| Vector2::new(x, y);
    let nodes = vec![at(2.0, 1.0), at(8.0, 1.0), at(2.0, 5.0), at(8.0, 5.0)];
    let graph = WaypointGraph::new(nodes, vec![(0, 1), (0, 2), (2, 3), (3, 1)]).unwrap();
    let (start, goal) = (Pose2::new(1.0, 1.2, 0.0), Pose2::new(9.0, 1.2, 0.0));
    let mut grid = hall();
    let mut planner = planner(at_home(), RADIUS);
    let direct = found_plan(planner.plan_on_graph(&grid, &graph, start, Twist2::ZERO, goal));
    judge(&grid, &direct, start, goal, RADIUS);
    assert!(direct.waypoints.points().contains(&at(2.0, 1.0)) && direct.length < 8.3);
    let off_the_lane = |plan: &PlanResult| -> f64 {
        let beside = |p: Vector2| {
            (p.y - 1.0).abs().min((p.y - 5.0).abs()).min((p.x - 2.0).abs()).min((p.x - 8.0).abs())
        };
        plan.trajectory.points().iter().map(|point| beside(point.pose.position())).fold(0.0, f64::max)
    };
    assert!(off_the_lane(&direct) < 0.25, "{}", off_the_lane(&direct));
    (0..30).for_each(|row| grid.set(trundle_core::CellIndex { col: 50, row }, Cell::Occupied));
    let around = found_plan(planner.plan_on_graph(&grid, &graph, start, Twist2::ZERO, goal));
    judge(&grid, &around, start, goal, RADIUS);
    assert!(around.waypoints.points().contains(&at(8.0, 5.0)));
    assert!(off_the_lane(&around) < 0.3, "{}", off_the_lane(&around));
    (0..60).for_each(|row| grid.set(trundle_core::CellIndex { col: 50, row }, Cell::Occupied));
    let blocked = planner.plan_on_graph(&grid, &graph, start, Twist2::ZERO, goal);
    assert!(matches!(blocked, Plan::Blocked { .. }), "{blocked}");
}

#[test]
fn where_no_lanes_lead_to_the_goal_the_robot_does_not_cross_the_room() {
    let at = |x: f64, y: f64| Vector2::new(x, y);
    let nodes = vec![at(1.0, 1.0), at(8.0, 1.0), at(8.0, 5.0)];
    let there = WaypointGraph::one_way(nodes, vec![(0, 1), (1, 2)]).unwrap();
    let (here, goal) = (Pose2::new(1.2, 1.0, 0.0), Pose2::new(8.0, 4.8, 1.6));
    let mut planner = planner(at_home(), RADIUS);
    found_plan(planner.plan_on_graph(&hall(), &there, here, Twist2::ZERO, goal));
    let back = planner.plan_on_graph(&hall(), &there, goal, Twist2::ZERO, here);
    assert!(matches!(back, Plan::Blocked { .. }), "{back}");
}

#[test]
fn a_tour_keeps_to_lanes_that_are_one_way() {
    let at = |x: f64, y: f64| Vector2::new(x, y);
    let nodes = vec![at(2.0, 1.0), at(8.0, 1.0), at(8.0, 5.0), at(2.0, 5.0)];
    let ring = WaypointGraph::one_way(nodes, vec![(0, 1), (1, 2), (2, 3), (3, 0)]).unwrap();
    let start = Pose2::new(1.8, 1.0, 0.0);
    let goals = [Pose2::new(8.3, 1.0, 0.0), Pose2::new(1.7, 1.0, 3.0)];
    let mut planner = planner(at_home(), RADIUS);
    let plan = planner.plan_multi_goal_on_graph(&hall(), &ring, start, Twist2::ZERO, &goals).unwrap();
    assert!(plan.legs[0].length < 7.0 && plan.legs[1].length > 13.0, "back the long way round");
    assert!(plan.legs[1].waypoints.points().contains(&at(2.0, 5.0)));
}

#[test]
fn a_blocked_goal_is_approached_as_far_as_allowed() {
    let mut grid = hall();
    for col in 70..80 {
        (25..35).for_each(|row| grid.set(trundle_core::CellIndex { col, row }, Cell::Occupied));
    }
    let (start, goal) = (Pose2::new(1.0, 3.0, 0.0), Pose2::new(7.5, 3.0, 0.5));
    let refused = planner(at_home(), RADIUS).plan(&grid, start, Twist2::ZERO, goal);
    assert!(matches!(refused, Plan::GoalInObstacle { .. }));
    let near = |goal_tolerance| {
        let mut config = at_home();
        config.goal_tolerance = goal_tolerance;
        config
    };
    let short = planner(near(0.3), RADIUS).plan(&grid, start, Twist2::ZERO, goal);
    assert!(matches!(short, Plan::Blocked { .. }), "{short}");
    let result = found_plan(planner(near(1.0), RADIUS).plan(&grid, start, Twist2::ZERO, goal));
    let end = result.trajectory.end();
    assert!(end.distance(&goal) < 0.8 && (end.theta - 0.5).abs() < 1e-9, "{end:?}");
    assert!(min_clearance(&grid, &result) >= RADIUS - 2e-4);
}

#[test]
fn expensive_cells_are_avoided_if_the_detour_is_small() {
    let grid = hall();
    let (start, goal) = (Pose2::new(1.0, 3.0, 0.0), Pose2::new(9.0, 3.0, 0.0));
    let geometry = GridGeometry::new(0.25, Vector2::new(4.0, 1.0), 8, 10).unwrap();
    let within = |value: u8| {
        let mut planner = planner(at_home(), RADIUS);
        planner.set_cost_mask(Some(CostMask::new(geometry, vec![value; geometry.len()]).unwrap()));
        let plan = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
        judge(&grid, &plan, start, goal, RADIUS);
        let inside = |p: Vector2| (4.1..5.9).contains(&p.x) && (1.1..3.4).contains(&p.y);
        let points = plan.trajectory.points();
        (points.iter().filter(|p| inside(p.pose.position())).count(), plan.length)
    };
    let (through, straight) = within(1);
    let (around, longer) = within(90);
    assert!(through > 0 && (straight - 8.0).abs() < 0.01, "{through} {straight}");
    assert!(around == 0 && longer > 8.03 && longer < 9.5, "{around} {longer}");
    // A speed or cost mask everywhere is not a wall: a path exists.
    let everywhere = GridGeometry::new(1.0, Vector2::zeros(), 10, 6).unwrap();
    let mut planner = planner(at_home(), RADIUS);
    planner.set_cost_mask(Some(CostMask::new(everywhere, vec![99; 60]).unwrap()));
    assert!((found_plan(planner.plan(&grid, start, Twist2::ZERO, goal)).length - 8.0).abs() < 0.01);
    assert!(CostMask::new(everywhere, vec![101; 60]).is_err() && CostMask::new(everywhere, vec![1]).is_err());
}

#[test]
fn a_goal_nearby_says_why() {
    let grid = hall();
    let mut mask = OccupancyGrid::filled(*grid.geometry(), Cell::Free);
    (70..100).for_each(|col| {
        (0..60).for_each(|row| mask.set(trundle_core::CellIndex { col, row }, Cell::Occupied))
    });
    let mut config = at_home();
    config.goal_tolerance = 2.0;
    let mut planner = planner(config, RADIUS);
    planner.set_keep_out(Some(mask));
    let start = Pose2::new(1.0, 3.0, 0.0);
    let near = found_plan(planner.plan(&grid, start, Twist2::ZERO, Pose2::new(8.0, 3.0, 0.0)));
    assert!(matches!(near.instead_of, Some(Plan::GoalInObstacle { .. })), "{:?}", near.instead_of);
    let there = found_plan(planner.plan(&grid, start, Twist2::ZERO, Pose2::new(6.0, 3.0, 0.0)));
    assert_eq!(there.instead_of, None);
}

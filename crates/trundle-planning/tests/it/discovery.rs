//! A robot that discovers its map during the drive: unknown at first, observed within a radius, with a new plan every second.

use crate::support::{clearance, found_plan, planner};
use trundle_core::{Cell, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::PlannerConfig;

const HOUSE: &str = "
    ############################################################
    #............................#.............................#
    #............................#.............................#
    #............................#.............................#
    #............................#.............................#
    #.......######...............#..............####...........#
    #.......######...............#..............####...........#
    #.......######...............#..............####...........#
    #............................#..............####...........#
    #..........................................................#
    #..........................................................#
    #..........................................................#
    #..........................................................#
    #..........................................................#
    #............................#.............................#
    #................###.........#......######.................#
    #................###.........#......######.................#
    #................###.........#......######.................#
    #............................#......######.................#
    #............................#.............................#
    #............................#.............................#
    #............................#.............................#
    #............................#.............................#
    ############################################################";

/// Copies all cells within 1.5 m, without regard to walls.
fn look(world: &OccupancyGrid, from: Vector2, map: &mut OccupancyGrid) {
    let geometry = *world.geometry();
    for linear in 0..geometry.len() {
        let cell = geometry.cell(linear);
        if (geometry.center(cell) - from).norm() < 1.5 {
            map.set(cell, world.get(cell));
        }
    }
}

#[test]
fn the_goal_is_reached_through_a_house_never_seen() {
    let world = OccupancyGrid::from_ascii(0.1, HOUSE).unwrap();
    let mut map = OccupancyGrid::filled(*world.geometry(), Cell::Unknown);
    let mut planner = planner(PlannerConfig::default(), 0.1755);
    let goal = Pose2::new(5.2, 0.5, -std::f64::consts::FRAC_PI_2);
    let (mut pose, mut twist) = (Pose2::new(0.6, 1.9, 0.4), Twist2::ZERO);
    let (mut time, mut plans, mut breaks, mut min) = (0.0, 0, 0, f64::INFINITY);
    while pose.distance(&goal) > 1e-3 || twist != Twist2::ZERO {
        look(&world, pose.position(), &mut map);
        let plan = found_plan(planner.plan(&map, pose, twist, goal));
        plans += 1;
        breaks += usize::from(!plan.is_continuous);
        let begin = plan.trajectory.points()[0];
        assert!(!plan.is_continuous || (begin.twist.v - twist.v).abs() < 1e-9, "{twist:?} {begin:?}");
        let mut now = 0.0;
        while now < plan.trajectory.duration().min(1.0) {
            now += 0.1;
            let at = plan.trajectory.at(now);
            (pose, twist) = (at.pose, at.twist);
            min = min.min(clearance(&world, pose.position()));
            look(&world, pose.position(), &mut map);
            if planner.validate_trajectory(&map, &plan.trajectory, now).is_err() {
                break;
            }
        }
        time += now;
        assert!(time < 90.0, "{pose:?}");
    }
    eprintln!(
        "house: {time:.1} s, {plans} plans, {breaks} from rest although moving, {:.3} m of room",
        min - 0.1755
    );
    assert!(min >= 0.1755 - 2e-4 && breaks * 5 <= plans, "{min} {breaks} {plans}");
}

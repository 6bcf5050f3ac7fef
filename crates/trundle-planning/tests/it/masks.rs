//! Laws of masks, of the validation of trajectories, and of encounters.

use crate::support::{at_home, clearance, found_plan, planner};
use trundle_core::{
    Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2, Trajectory, TrajectoryPoint, Twist2, Vector2,
};
use trundle_planning::{CostMask, MovingObstacle, PlanResult, Planner, SpeedMask};

const RADIUS: f64 = 0.17;

/// An open floor of 6 m by 4 m.
fn floor() -> OccupancyGrid {
    OccupancyGrid::from_ascii(0.1, &vec![".".repeat(60); 40].join("\n")).unwrap()
}

fn start() -> Pose2 {
    Pose2::new(0.8, 2.0, 0.0)
}

fn goal() -> Pose2 {
    Pose2::new(5.2, 2.0, 0.0)
}

fn planned(planner: &mut Planner) -> Box<PlanResult> {
    found_plan(planner.plan(&floor(), start(), Twist2::ZERO, goal()))
}

/// The cells of the floor in a box, m.
fn mask(low: (f64, f64), high: (f64, f64)) -> OccupancyGrid {
    let mut mask = floor();
    let geometry = *mask.geometry();
    for cell in (0..geometry.len()).map(|linear| geometry.cell(linear)) {
        let p = geometry.center(cell);
        if p.x > low.0 && p.x < high.0 && p.y > low.1 && p.y < high.1 {
            mask.set(cell, Cell::Occupied);
        }
    }
    mask
}

#[test]
fn neutral_masks_change_no_bit_of_the_plan() {
    let plain = planned(&mut planner(at_home(), RADIUS));
    let (geometry, cells) = (*floor().geometry(), floor().geometry().len());
    let mut masked = planner(at_home(), RADIUS);
    masked.set_keep_out(Some(floor()));
    masked.set_speed_mask(Some(SpeedMask::new(geometry, vec![f32::INFINITY; cells]).unwrap()));
    masked.set_cost_mask(Some(CostMask::new(geometry, vec![0; cells]).unwrap()));
    assert_eq!(planned(&mut masked).trajectory, plain.trajectory);
    masked.set_keep_out(None);
    masked.set_speed_mask(None);
    masked.set_cost_mask(None);
    assert_eq!(planned(&mut masked).trajectory, plain.trajectory);
}

#[test]
fn a_keep_out_area_is_kept_out_of_as_if_it_were_occupied() {
    let area = mask((2.5, 1.0), (3.5, 4.0));
    let mut masked = planner(at_home(), RADIUS);
    masked.set_keep_out(Some(area.clone()));
    let around = planned(&mut masked);
    for point in around.trajectory.points() {
        assert!(clearance(&area, point.pose.position()) >= RADIUS - 2e-4, "{point:?}");
    }
    let occupied = found_plan(planner(at_home(), RADIUS).plan(&area, start(), Twist2::ZERO, goal()));
    assert_eq!(around.trajectory, occupied.trajectory);
}

#[test]
fn no_sample_is_faster_than_the_speed_mask_and_the_rest_of_the_path_is_as_fast_as_without() {
    let (geometry, plain) = (*floor().geometry(), planned(&mut planner(at_home(), RADIUS)));
    let limit =
        |linear: usize| if (20..40).contains(&geometry.cell(linear).col) { 0.2 } else { f32::INFINITY };
    let speeds = SpeedMask::new(geometry, (0..geometry.len()).map(limit).collect()).unwrap();
    let mut masked = planner(at_home(), RADIUS);
    masked.set_speed_mask(Some(speeds.clone()));
    let slow = planned(&mut masked);
    for point in slow.trajectory.points() {
        assert!(point.twist.v <= speeds.limit(point.pose.position()) + 1e-6, "{point:?}");
    }
    assert!(slow.trajectory.duration() > plain.trajectory.duration() + 3.0);
    assert!((slow.length - plain.length).abs() < 1e-9);
}

#[test]
fn a_cost_is_avoided_where_that_is_cheap_and_crossed_where_there_is_no_other_path() {
    let geometry = *floor().geometry();
    let costs = |area: &OccupancyGrid| {
        let values = area.cells().iter().map(|cell| if *cell == Cell::Occupied { 100 } else { 0 });
        CostMask::new(geometry, values.collect()).unwrap()
    };
    let crossed = |area: &OccupancyGrid, inside: &OccupancyGrid| {
        let mut masked = planner(at_home(), RADIUS);
        masked.set_cost_mask(Some(costs(area)));
        let waypoints = planned(&mut masked).waypoints;
        let samples = waypoints
            .points()
            .windows(2)
            .flat_map(|pair| (0..=100).map(|i| pair[0].lerp(&pair[1], f64::from(i) / 100.0)));
        samples.filter(|p| inside.at(*p) == Cell::Occupied).count()
    };
    // A path may touch the border of an area.
    assert_eq!(crossed(&mask((2.5, 1.7), (3.5, 2.3)), &mask((2.6, 1.8), (3.4, 2.2))), 0);
    let across = mask((2.5, 0.0), (3.5, 4.0));
    assert!(crossed(&across, &across) > 10);
}

#[test]
fn a_trajectory_is_valid_until_something_stands_on_the_rest_of_it() {
    let mut robot = planner(at_home(), RADIUS);
    let plan = planned(&mut robot);
    assert!(robot.validate_trajectory(&floor(), &plan.trajectory, 0.0).is_ok());
    let half = plan.trajectory.duration() / 2.0;
    let blocked = |time: f64| {
        let (mut grid, p) = (floor(), plan.trajectory.at(time).pose.position());
        let cell = grid.geometry().cell_at(p).unwrap();
        grid.set(cell, Cell::Occupied);
        grid
    };
    let (ahead, behind) =
        (blocked(0.75 * plan.trajectory.duration()), blocked(0.2 * plan.trajectory.duration()));
    assert!(robot.validate_trajectory(&ahead, &plan.trajectory, half).is_err());
    assert!(robot.validate_trajectory(&behind, &plan.trajectory, half).is_ok());
    assert!(robot.validate_trajectory(&behind, &plan.trajectory, 0.0).is_err());
}

/// A straight drive along x at 0.5 m/s for 4 s.
fn straight() -> Trajectory {
    let at = |time: f64| TrajectoryPoint {
        time,
        pose: Pose2::new(0.5 * time, 0.0, 0.0),
        twist: Twist2::new(0.5, 0.0),
    };
    Trajectory::new((0..=40).map(|i| at(0.1 * f64::from(i))).collect()).unwrap()
}

#[test]
fn a_head_on_encounter_comes_after_the_gap_over_the_closing_speed() {
    let robot = planner(at_home(), RADIUS);
    let first = |x: f64, v: f64, from: f64| {
        let obstacle = MovingObstacle::new(Vector2::new(x, 0.0), Vector2::new(v, 0.0), 0.23).unwrap();
        robot.first_encounter(&straight(), from, &[obstacle])
    };
    // 1.9 m apart, radii of 0.4 m in all, 1.5 m/s towards each other: 1 s.
    let time = first(1.9, -1.0, 0.0).unwrap();
    assert!((time - 1.0).abs() <= 0.02 + 1e-9, "{time}");
    assert_eq!(first(1.9, 0.5, 0.0), None, "as fast as the robot");
    assert_eq!(first(-0.6, -1.0, 0.0), None, "behind, and going away");
    assert_eq!(first(9.0, -1.0, 0.0), None, "beyond the forecast");
    // A second later the robot is half a metre further: a third of a second less.
    let later = first(1.9, -1.0, 1.0).unwrap();
    assert!((time - later - 1.0 / 3.0).abs() <= 0.04 + 1e-9, "{later}");
    assert_eq!(robot.first_encounter(&straight(), 0.0, &[]), None);
}

#[test]
fn the_limit_of_a_speed_mask_is_that_of_the_cell_and_none_outside() {
    let geometry = GridGeometry::new(0.5, Vector2::new(-1.0, -1.0), 4, 4).unwrap();
    let mask = SpeedMask::new(geometry, (1..=16).map(|i| i as f32 * 0.1).collect()).unwrap();
    for linear in 0..16 {
        let limit = mask.limit(geometry.center(geometry.cell(linear)));
        assert!((limit - 0.1 * (linear + 1) as f64).abs() < 1e-6);
    }
    let corner: Vector2 = geometry.center(CellIndex { col: 0, row: 0 }) - Vector2::repeat(0.3);
    assert_eq!(mask.limit(corner), f64::INFINITY);
}

//! Guarantees for a user: no swinging in corridors, the same bytes, speeds that go with room and sight, no jump in curvature.

use crate::support::{LIMITS, at_home, found_plan, judge, planner};
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2, TrajectoryPoint, Twist2, Vector2};
use trundle_planning::{PlanResult, PotentialKind, TimingConfig};

const RADIUS: f64 = 0.1755;

/// A corridor 12 m long along x, `wide` cells of 5 cm wide; rough walls have single protruding cells.
fn corridor(wide: usize, rough: bool) -> OccupancyGrid {
    let geometry = GridGeometry::new(0.05, Vector2::zeros(), 240, wide + 4).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    for col in 0..240 {
        let sticks = |phase: usize| usize::from(rough && (col * 7 + phase) % 11 < 2);
        let (low, high) = (2 + sticks(0), 2 + sticks(5));
        (0..low).for_each(|row| grid.set(CellIndex { col, row }, Cell::Occupied));
        (wide + 4 - high..wide + 4).for_each(|row| grid.set(CellIndex { col, row }, Cell::Occupied));
    }
    grid
}

/// Number of changes of the bend's side along the curve, without bends below one degree.
fn swings(result: &PlanResult) -> usize {
    let (mut side, mut bend, mut count) = (0.0_f64, 0.0, 0);
    for curve in result.curves() {
        for pair in curve.samples(0.01).windows(2) {
            let turn = pair[0].curvature * (pair[1].arc - pair[0].arc);
            bend = if turn * bend < 0.0 { turn } else { bend + turn };
            if bend.abs() > 0.017 && bend.signum() != side {
                count += usize::from(side != 0.0);
                side = bend.signum();
            }
        }
    }
    count
}

#[test]
fn nothing_swings_in_a_corridor() {
    for kind in [PotentialKind::Geodesic, PotentialKind::Printed] {
        let mut config = at_home();
        config.potential.kind = kind;
        let mut planner = planner(config, RADIUS);
        for (wide, rough) in [(9, false), (12, true), (16, true), (24, false), (24, true)] {
            let grid = corridor(wide, rough);
            let middle = f64::from(wide as u32 + 4) * 0.025;
            for off in [0.0, 0.02] {
                let (start, goal) = (Pose2::new(0.5, middle + off, 0.0), Pose2::new(11.5, middle - off, 0.0));
                let result = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
                judge(&grid, &result, start, goal, RADIUS);
                let turned: f64 =
                    result.trajectory.points().iter().map(|p| p.pose.theta.abs()).fold(0.0, f64::max);
                assert!(swings(&result) <= 3, "{kind:?} {wide} {rough} {off}: {} swings", swings(&result));
                assert!(
                    turned < 0.2 && result.length < 11.03,
                    "{kind:?} {wide}: {turned} rad, {} m",
                    result.length
                );
            }
        }
    }
}

#[test]
fn the_same_question_gives_the_same_bytes_whatever_was_asked_before() {
    let grid = corridor(24, true);
    let (start, goal) = (Pose2::new(0.5, 0.7, 0.3), Pose2::new(11.5, 0.7, -2.0));
    let bytes = |result: &PlanResult| -> Vec<u64> {
        let points = result.trajectory.points().iter();
        points
            .flat_map(|p| [p.time, p.pose.x, p.pose.y, p.pose.theta, p.twist.v, p.twist.omega])
            .map(f64::to_bits)
            .collect()
    };
    let fresh = bytes(&found_plan(planner(at_home(), RADIUS).plan(&grid, start, Twist2::ZERO, goal)));
    let mut used = planner(at_home(), RADIUS);
    let mut other = grid.clone();
    for k in 0..5 {
        // Other queries, other maps, another extent.
        other.set(CellIndex { col: 40 + 30 * k, row: 12 }, Cell::Occupied);
        let _ =
            used.plan(&other, Pose2::new(6.0, 0.7, 1.0), Twist2::new(0.3, 0.1), Pose2::new(0.5, 0.6, 0.0));
        let _ = used.plan(&corridor(40, false), start, Twist2::ZERO, goal);
        assert_eq!(bytes(&found_plan(used.plan(&grid, start, Twist2::ZERO, goal))), fresh, "{k}");
    }
}

#[test]
fn speed_goes_with_the_room_beside_the_robot() {
    let timing = TimingConfig::default();
    let mut last = 0.0;
    for wide in [8, 10, 12, 14, 16, 20] {
        let grid = corridor(wide, false);
        let middle = f64::from(wide as u32 + 4) * 0.025;
        let (start, goal) = (Pose2::new(0.5, middle, 0.0), Pose2::new(11.5, middle, 0.0));
        let result = found_plan(planner(at_home(), RADIUS).plan(&grid, start, Twist2::ZERO, goal));
        let fastest = result.trajectory.points().iter().map(|p| p.twist.v).fold(0.0, f64::max);
        let room = wide as f64 * 0.025 - RADIUS;
        let share = (room / timing.full_speed_clearance).min(1.0);
        let ceiling = timing.slow_speed + (LIMITS.v - timing.slow_speed) * share;
        assert!(fastest <= ceiling + 0.01, "{wide} cells: {fastest} of {ceiling} m/s");
        assert!(fastest > 0.75 * ceiling && fastest > last, "{wide} cells: {fastest} of {ceiling} m/s");
        last = fastest;
    }
}

/// The robot has observed 2.5 m ahead: it drives slowly beyond this distance, and has slowed down before.
#[test]
fn speed_is_limited_by_what_has_been_seen() {
    let limit = TimingConfig::default().unknown_speed;
    for seen in [1.5, 2.5, 4.0] {
        let mut grid = OccupancyGrid::filled(
            GridGeometry::new(0.05, Vector2::zeros(), 200, 100).unwrap(),
            Cell::Unknown,
        );
        for linear in 0..grid.geometry().len() {
            let cell = grid.geometry().cell(linear);
            if (grid.geometry().center(cell) - Vector2::new(1.0, 2.5)).norm() < seen {
                grid.set(cell, Cell::Free);
            }
        }
        let (start, goal) = (Pose2::new(1.0, 2.5, 0.0), Pose2::new(9.0, 2.5, 0.0));
        let result = found_plan(planner(at_home(), RADIUS).plan(&grid, start, Twist2::ZERO, goal));
        let points = result.trajectory.points();
        let is_unknown =
            |p: &&TrajectoryPoint| grid.at(p.pose.position() + p.pose.direction() * RADIUS) == Cell::Unknown;
        assert!(points.iter().filter(is_unknown).all(|p| p.twist.v <= limit + 1e-6), "{seen}");
        let known = points.iter().filter(|p| !is_unknown(p));
        assert!(known.map(|p| p.twist.v).fold(0.0, f64::max) > limit + 0.1, "{seen}: slow everywhere");
    }
}

/// From any moment of a plan, after any change, the new curve begins with the reference's curvature and speed.
#[test]
fn replanning_goes_on_in_place_heading_curvature_and_speed() {
    let grid =
        OccupancyGrid::filled(GridGeometry::new(0.05, Vector2::zeros(), 200, 120).unwrap(), Cell::Free);
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.8), Pose2::new(8.0, 4.5, -0.6));
    let mut planner = planner(at_home(), RADIUS);
    let first = found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    let mut bent = 0;
    for k in 1..14 {
        let now = first.trajectory.at(first.trajectory.duration() * f64::from(k) / 15.0);
        let mut changed = grid.clone();
        let ahead = now.pose.position() + now.pose.direction() * 2.0;
        for linear in 0..grid.geometry().len() {
            let cell = grid.geometry().cell(linear);
            if (grid.geometry().center(cell) - ahead).norm() < 0.3 {
                changed.set(cell, Cell::Occupied);
            }
        }
        let other = Pose2::new(8.5, 1.5, 0.0);
        let second = found_plan(planner.plan(&changed, now.pose, now.twist, other));
        if now.twist.v < 0.05 || !second.is_continuous {
            continue;
        }
        let begin = second.trajectory.points()[0];
        let curvature = |twist: Twist2| twist.omega / twist.v;
        assert!(begin.pose.distance(&now.pose) < 1e-9 && (begin.twist.v - now.twist.v).abs() < 1e-9);
        assert!((curvature(begin.twist) - curvature(now.twist)).abs() < 1e-4, "{k}: {begin:?} {now:?}");
        let curve = second.curves().next().unwrap().samples(0.01)[0];
        assert!((curve.curvature - curvature(now.twist)).abs() < 1e-4, "{k}: {} {now:?}", curve.curvature);
        bent += usize::from(curvature(now.twist).abs() > 0.02);
    }
    assert!(bent >= 3, "only {bent} moments on a bend");
}

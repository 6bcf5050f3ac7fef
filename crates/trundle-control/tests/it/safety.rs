//! The safety monitor on simulated drives.

use crate::plant::{DT, Plant};
use proptest::prelude::*;
use trundle_control::{
    MotionSense, SafetyAction, SafetyConfig, SafetyInput, SafetyMemory, SafetyMonitor, SafetyReport,
    SafetyScan,
};
use trundle_core::{Beam, Cell, Footprint, GridGeometry, OccupancyGrid, Pose2, Scan, Stamp, Twist2, Vector2};

const RADIUS: f64 = 0.1755;

fn monitor() -> SafetyMonitor {
    SafetyMonitor::new(SafetyConfig::default(), &Footprint::KOBUKI).unwrap()
}

/// Walls as points a centimetre apart.
struct World {
    points: Vec<Vector2>,
}

impl World {
    fn segment(mut self, from: (f64, f64), to: (f64, f64)) -> Self {
        let (a, b) = (Vector2::new(from.0, from.1), Vector2::new(to.0, to.1));
        let n = ((b - a).norm() / 0.01).ceil() as usize;
        self.points.extend((0..=n).map(|i| a + (b - a) * (i as f64 / n as f64)));
        self
    }

    /// Scan of a Kinect at `pose`: 70 deg, half a metre and farther; one beam per degree.
    fn scan(&self, pose: Pose2, stamp: Stamp) -> Scan {
        let mut nearest = vec![f64::INFINITY; 70];
        for point in &self.points {
            let p = pose.inverse().transform(*point);
            let beam = (p.y.atan2(p.x).to_degrees() + 35.0).floor();
            if (0.0..70.0).contains(&beam) {
                let range = &mut nearest[beam as usize];
                *range = range.min(p.norm());
            }
        }
        let beam = |range: f64| match range {
            r if r < 0.5 => Beam::Unseen,
            r if r < 8.0 => Beam::Hit { range: r },
            _ => Beam::Free { range: 8.0 },
        };
        let beams = nearest.into_iter().map(beam).collect();
        Scan::new(stamp, Vector2::zeros(), (-34.5_f64).to_radians(), 1.0_f64.to_radians(), beams).unwrap()
    }

    /// The map of this world as drawn by a mapper.
    fn grid(&self) -> OccupancyGrid {
        let geometry = GridGeometry::new(0.05, Vector2::new(-4.0, -4.0), 200, 160).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        for &point in &self.points {
            if let Some(cell) = geometry.cell_at(point) {
                grid.set(cell, Cell::Occupied);
            }
        }
        grid
    }

    fn clearance(&self, pose: Pose2) -> f64 {
        self.points.iter().map(|p| (p - pose.position()).norm()).fold(f64::INFINITY, f64::min) - RADIUS
    }
}

fn empty() -> World {
    World { points: Vec::new() }
}

struct Drive {
    plant: Plant,
    min_clearance: f64,
    last: SafetyReport,
    slowest: f64,
}

/// Drives with one command for `seconds`; images at 12.5 Hz, one period late.
fn drive(world: &World, mut plant: Plant, command: Twist2, seconds: f64, with_map: bool) -> Drive {
    let (mut monitor, grid) = (monitor(), world.grid());
    let mut last = SafetyReport { twist: Twist2::ZERO, action: SafetyAction::Pass };
    let mut images = vec![(world.scan(plant.pose, plant.now), plant.pose)];
    let (mut min_clearance, mut slowest) = (f64::INFINITY, f64::INFINITY);
    for i in 0..(seconds / DT) as usize {
        if i % 4 == 0 {
            images.push((world.scan(plant.pose, plant.now), plant.pose));
        }
        let (scan, odom_at_scan) = &images[images.len() - 2];
        let memory = SafetyMemory { grid: &grid, unconfirmed: &[], map_from_base: plant.pose };
        last = monitor.check(&SafetyInput {
            now: plant.now,
            twist: command,
            scan: Some(SafetyScan { scan, odom_at_scan: *odom_at_scan, odom_now: plant.pose }),
            memory: with_map.then_some(memory),
            touched: false,
            over_edge: false,
            hold: None,
            image: Some(scan.stamp()),
            wheels: Some(plant.now),
            motion: MotionSense::Wheels,
            station: None,
        });
        plant.drive(last.twist);
        min_clearance = min_clearance.min(world.clearance(plant.pose));
        slowest = slowest.min(last.twist.v.abs());
    }
    Drive { plant, min_clearance, last, slowest }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn before_a_wall_it_stops_at_any_speed(
        v in 0.05..0.70,
        share in -1.0..1.0,
        slant in -0.7..0.7,
        delay in 0.02..0.05,
    ) {
        let (v, share, slant): (f64, f64, f64) = (v, share, slant);
        let omega = share * 0.3 * v;
        let (c, s) = (slant.cos(), slant.sin());
        let wall = empty().segment((1.6 + 2.0 * s, -2.0 * c), (1.6 - 2.0 * s, 2.0 * c));
        let command = Twist2::new(v, omega);
        let mut plant = Plant::at(Pose2::IDENTITY).moving(command);
        plant.delay = delay;
        let drive = drive(&wall, plant, command, 3.0 + 2.0 / v, true);
        prop_assert!(drive.min_clearance > 0.0, "{} m", drive.min_clearance);
        // A twist that bends away from the wall may continue along it.
        prop_assert!(drive.last.twist.v < if share.abs() < 0.2 { 0.02 } else { 0.15 }, "{:?}", drive.last);
    }

    #[test]
    fn walls_beside_a_corridor_never_stop_it(v in 0.1..0.70, width in 0.7..1.2, offset in -1.0..1.0) {
        let (v, width): (f64, f64) = (v, width);
        // Any lateral position in the corridor with 1.5 cm left on either side of the map's cells, which may be one cell too near.
        let y = offset * (width / 2.0 - RADIUS - 0.05 - 0.015);
        let corridor = empty().segment((-3.9, -width / 2.0), (5.9, -width / 2.0));
        let corridor = corridor.segment((-3.9, width / 2.0), (5.9, width / 2.0));
        let command = Twist2::new(v, 0.0);
        let start = Pose2::new(-2.5, y, 0.0);
        let drive = drive(&corridor, Plant::at(start).moving(command), command, 2.5 / v, true);
        prop_assert!(drive.slowest >= 0.1_f64.min(v) - 1e-9, "{} m/s at {:?}", drive.slowest, drive.last);
    }
}

#[test]
fn a_gap_of_70_cm_is_passed() {
    let gap = empty().segment((1.0, -2.0), (1.0, -0.35)).segment((1.0, 0.35), (1.0, 2.0));
    for y in [0.0, 0.1, -0.1] {
        let command = Twist2::new(0.3, 0.0);
        let drive = drive(&gap, Plant::at(Pose2::new(0.0, y, 0.0)), command, 12.0, true);
        assert!(drive.plant.pose.x > 1.5, "stuck at {:?}: {}", drive.plant.pose, drive.last.action);
    }
}

#[test]
fn the_map_covers_the_blind_zone_of_the_camera() {
    let box_ahead = empty().segment((0.45, -0.1), (0.45, 0.1));
    let command = Twist2::new(0.3, 0.0);
    let start = || Plant::at(Pose2::IDENTITY);
    let without = drive(&box_ahead, start(), command, 3.0, false);
    assert!(without.min_clearance < 0.0, "the camera does not see it: the test tests nothing");
    let with = drive(&box_ahead, start(), command, 3.0, true);
    assert!(with.min_clearance > 0.0, "{}", with.min_clearance);
    assert!(matches!(with.last.action, SafetyAction::Stop(_)), "{}", with.last.action);
}

#[test]
fn the_map_stops_driving_backward_into_a_wall() {
    let wall = empty().segment((-0.8, -1.0), (-0.8, 1.0));
    let drive = drive(&wall, Plant::at(Pose2::IDENTITY), Twist2::new(-0.4, 0.2), 8.0, true);
    assert!(drive.min_clearance > 0.0 && drive.last.twist.v > -0.02, "{}", drive.last.action);
}

#[test]
fn without_obstacles_the_command_passes() {
    let command = Twist2::new(0.7, 0.0);
    let drive = drive(&empty(), Plant::at(Pose2::IDENTITY).moving(command), command, 2.0, true);
    assert_eq!(drive.last, SafetyReport { twist: command, action: SafetyAction::Pass });
}

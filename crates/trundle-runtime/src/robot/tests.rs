//! Laws of the robot's state between steps.

use super::*;
use proptest::prelude::*;
use trundle_core::{Beam, Footprint, OccupancyGrid, Twist2, Vector2};
use trundle_planning::{MovingObstacleTracker, ObstacleTrackerConfig};

fn scan(stamp: Stamp) -> Scan {
    Scan::new(stamp, Vector2::zeros(), 0.0, 0.1, vec![Beam::Free { range: 3.0 }; 20]).unwrap()
}

/// Sweeps over a disc of 0.2 m, 2 m ahead, that moves to the left at 0.8 m/s for `seconds`.
fn walker(seconds: f64) -> (MovingObstacleTracker, Stamp) {
    let mut tracker = MovingObstacleTracker::new(ObstacleTrackerConfig::default()).unwrap();
    let step = 1_f64.to_radians();
    let mut now = Stamp::default();
    for i in 0..(seconds * 10.0) as i32 {
        now = Stamp::default().after(0.1 * f64::from(i));
        let center = Vector2::new(2.0, -1.0 + 0.08 * f64::from(i));
        let beam = |k: i32| {
            let direction = Vector2::new((f64::from(k) * step).cos(), (f64::from(k) * step).sin());
            let (along, aside) = (center.dot(&direction), center.perp(&direction).abs());
            let range = along - (0.04 - aside * aside).max(0.0).sqrt();
            if aside < 0.2 && along > 0.0 { Beam::Hit { range } } else { Beam::Free { range: 5.0 } }
        };
        let sweep =
            Scan::new(now, Vector2::zeros(), -60.0 * step, step, (-60..=60).map(beam).collect()).unwrap();
        tracker.add_scan(Pose2::IDENTITY, &sweep);
    }
    (tracker, now)
}

#[test]
fn dynamic_obstacles_move_on_while_scans_are_recent_and_are_dropped_when_none_comes() {
    let (tracker, last) = walker(2.5);
    let movers = tracker.moving_obstacles(last);
    assert_eq!(movers.len(), 1, "{movers:?}");
    let grid = OccupancyGrid::from_ascii(0.1, "..\n..\n").unwrap();
    let mut tracks = ObstacleTracks::tracking(tracker, movers, grid);
    let before = tracks.movers[0].at(0.0);
    tracks.forecast(Some(last), last.after(0.5));
    let moved = tracks.movers[0].at(0.0) - before;
    assert!((moved - Vector2::new(0.0, 0.4)).norm() < 0.15, "{moved}");
    assert!(tracks.static_grid.is_some());
    tracks.forecast(Some(last), last.after(1.1 * obstacles::MAX_TRACK_AGE_S));
    assert!(tracks.movers.is_empty() && tracks.static_grid.is_none(), "where it is nothing says");
}

#[test]
fn a_scan_without_odometry_gives_safety_nothing() {
    let odometry = |x: f64| Odometry {
        stamp: Stamp::default(),
        pose: Pose2::new(x, 0.0, 0.0),
        twist: Twist2::ZERO,
        covariance: nalgebra::Matrix3::zeros(),
    };
    let mut latest = Latest { scan: Some(scan(Stamp::default())), ..Latest::default() };
    assert!(latest.scan_with_odometry().is_none());
    latest.odometry = Some(odometry(0.3));
    assert!(latest.scan_with_odometry().is_none(), "taken at an unknown place");
    latest.scan_odometry = Some(Pose2::new(0.1, 0.0, 0.0));
    let carried = latest.scan_with_odometry().unwrap();
    assert_eq!((carried.odom_at_scan.x, carried.odom_now.x), (0.1, 0.3));
}

#[test]
fn the_source_of_motion_depends_on_wheels_and_sensor() {
    let now = Stamp::default().after(10.0);
    let sense = |sight, is_stuck: bool, located: Option<f64>| {
        let mut robot = Robot::new(RobotConfig { sight, ..RobotConfig::default() }).unwrap();
        for i in 0..100 {
            let stamp = Stamp::default().after(0.02 * f64::from(i));
            robot.odometry.set_command(Twist2::new(if is_stuck { 0.3 } else { 0.0 }, 0.0));
            robot.odometry.step_wheels(&WheelTicks { stamp, left: 0, right: 0 });
        }
        robot.latest.located = located.map(|age| now.after(-age));
        robot.motion_sense(now)
    };
    let (camera, laser) = (RangeSource::DepthCamera, RangeSource::Laser);
    assert_eq!(sense(camera, false, None), MotionSense::Wheels);
    assert_eq!(sense(camera, true, None), MotionSense::Nothing);
    assert_eq!(sense(camera, true, Some(0.9 * MAX_VISUAL_MOTION_AGE_S)), MotionSense::Sight);
    assert_eq!(sense(camera, true, Some(1.1 * MAX_VISUAL_MOTION_AGE_S)), MotionSense::Nothing);
    assert_eq!(sense(laser, true, None), MotionSense::Sight);
}

proptest! {
    #[test]
    fn the_inscribed_disc_touches_the_outline_and_does_not_cross_it(
        front in 0.05..1.0_f64, back in 0.05..1.0_f64, left in 0.05..1.0_f64, right in 0.05..1.0_f64,
    ) {
        let corners = [(front, left), (-back, left), (-back, -right), (front, -right)];
        let outline = Footprint::polygon(corners.map(|(x, y)| Vector2::new(x, y)).to_vec()).unwrap();
        let nearest = front.min(back).min(left).min(right);
        prop_assert!((mapping::inscribed_radius(&outline) - nearest).abs() < 1e-9);
        prop_assert_eq!(mapping::inscribed_radius(&Footprint::disc(front).unwrap()), front);
        prop_assert!(crate::bumper::ahead_of(&outline).iter().all(|point| point.norm() > nearest));
    }
}

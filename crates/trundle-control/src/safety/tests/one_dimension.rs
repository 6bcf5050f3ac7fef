//! One dimension, exhaustively: a robot that drives at a wall with every combination of gap, command, image timing and loss of images.

use super::*;
use std::collections::VecDeque;

/// Period of a control step, and of the simulation, s.
const STEP_S: f64 = 0.02;
/// Longest simulated drive, s.
const DURATION_S: f64 = 8.0;

/// A drive at a wall.
#[derive(Debug, Clone, Copy)]
struct Drive {
    /// Distance of the wall from the front at the start, m.
    gap: f64,
    /// Commanded speed, m/s; negative with the wall behind.
    command: f64,
    /// Control steps from image to image.
    image_period: usize,
    /// Control steps from an image to its arrival.
    image_delay: usize,
    /// Control steps from a command to its effect.
    response: usize,
    /// Control step of the last image.
    last_image: usize,
}

/// The robot on a line: odometry without error, the deceleration of the configuration.
struct Robot {
    at: f64,
    speed: f64,
    commands: VecDeque<f64>,
}

impl Robot {
    /// One step with the command of `response` steps ago.
    fn drive(&mut self, command: f64, deceleration: f64) {
        self.commands.push_back(command);
        let effective = self.commands.pop_front().unwrap_or(0.0);
        let max = deceleration * STEP_S;
        let next = self.speed + (effective - self.speed).clamp(-max, max);
        self.at += (self.speed + next) / 2.0 * STEP_S;
        self.speed = next;
    }
}

/// A scan with one hit at `range` m ahead (behind for a reverse drive), seen from the base's origin.
fn hit(range: f64, sign: f64) -> Scan {
    let bearing = if sign > 0.0 { 0.0 } else { std::f64::consts::PI };
    scan(bearing, 0.1, &[range.max(1e-3)])
}

/// The smallest gap of the drive, m, and whether the robot moved.
fn smallest_gap(drive: Drive, config: &SafetyConfig) -> (f64, bool) {
    let mut monitor = SafetyMonitor::new(config.clone(), &Footprint::KOBUKI).unwrap();
    let (radius, sign) = (Footprint::KOBUKI.circumscribed_radius(), drive.command.signum());
    let mut robot = Robot { at: 0.0, speed: 0.0, commands: VecDeque::from(vec![0.0; drive.response]) };
    let mut taken: Vec<(usize, f64)> = Vec::new();
    let mut smallest = drive.gap;
    for step in 0..(DURATION_S / STEP_S) as usize {
        if step % drive.image_period == 0 && step <= drive.last_image {
            taken.push((step, robot.at));
        }
        let stamp = |step: usize| Stamp::default().after(step as f64 * STEP_S);
        let image = taken.iter().rev().find(|(at, _)| at + drive.image_delay <= step);
        let scan = image.map(|(_, at)| hit(drive.gap + radius - at.abs(), sign));
        let twist = Twist2::new(drive.command, 0.0);
        let input = SafetyInput {
            now: stamp(step),
            image: image.map(|(at, _)| stamp(*at)),
            wheels: Some(stamp(step)),
            scan: scan.as_ref().zip(image).map(|(scan, (_, at))| SafetyScan {
                scan,
                odom_at_scan: Pose2::new(*at, 0.0, 0.0),
                odom_now: Pose2::new(robot.at, 0.0, 0.0),
            }),
            ..fresh(twist)
        };
        robot.drive(monitor.check(&input).twist.v, config.deceleration);
        smallest = smallest.min(drive.gap - robot.at.abs());
    }
    (smallest, robot.at != 0.0)
}

/// Every drive of the grid.
fn drives() -> impl Iterator<Item = Drive> {
    let gaps = (0..=48).map(|i| 0.005 + 0.025 * f64::from(i));
    let commands = [-0.7, -0.2, 0.05, 0.3, 0.5, 0.7];
    let images = [(1, 0), (1, 4), (4, 2), (4, 4), (10, 3), (20, 5)];
    gaps.flat_map(move |gap| commands.map(|command| (gap, command)))
        .flat_map(move |start| images.map(|image| (start, image)))
        .flat_map(move |drive| [0, 3, 6].map(|response| (drive, response)))
        .flat_map(move |drive| [40, 75, usize::MAX].map(|last_image| (drive, last_image)))
        .map(|((((gap, command), (image_period, image_delay)), response), last_image)| Drive {
            gap,
            command,
            image_period,
            image_delay,
            response,
            last_image,
        })
}

#[test]
fn no_drive_at_a_wall_ends_in_contact_whatever_the_delays() {
    let config = SafetyConfig::default();
    let (mut moved, mut count) = (0, 0);
    for drive in drives() {
        let (gap, has_moved) = smallest_gap(drive, &config);
        assert!(gap > 0.0, "{drive:?}: {gap} m");
        (moved, count) = (moved + usize::from(has_moved), count + 1);
    }
    assert_eq!(count, 49 * 6 * 6 * 3 * 3);
    assert!(moved > count / 2, "{moved} of {count} drives moved: the others show nothing");
}

#[test]
fn a_braking_distance_set_too_short_is_found() {
    // The test can fail: a robot that brakes with half of the configured deceleration meets the wall.
    let config = SafetyConfig { deceleration: 1.0, ..SafetyConfig::default() };
    let weak = SafetyConfig { deceleration: 0.3, ..config.clone() };
    let is_contact = |drive: &Drive| {
        let mut monitor = SafetyMonitor::new(config.clone(), &Footprint::KOBUKI).unwrap();
        let radius = Footprint::KOBUKI.circumscribed_radius();
        let mut robot = Robot { at: 0.0, speed: 0.0, commands: VecDeque::from(vec![0.0; drive.response]) };
        (0..400).any(|_| {
            let wall = hit(drive.gap + radius - robot.at, 1.0);
            let input = SafetyInput { scan: seen(&wall), ..fresh(Twist2::new(drive.command, 0.0)) };
            robot.drive(monitor.check(&input).twist.v, weak.deceleration);
            robot.at >= drive.gap
        })
    };
    assert!(drives().filter(|drive| drive.command > 0.4).any(|drive| is_contact(&drive)));
}

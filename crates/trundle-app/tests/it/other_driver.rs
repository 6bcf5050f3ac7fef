//! A robot without a goal on a base that something else drives: SLAM alone.

use trundle_core::{Cell, Pose2, RobotBody, SensorEvent, Twist2};
use trundle_runtime::{DriveState, Robot, RobotConfig};
use trundle_sim::{Scene, SimConfig, Simulator};

/// Time of the drive \[s\]. Source: ours.
const DRIVE_S: f64 = 8.0;

#[test]
fn a_robot_without_a_goal_maps_while_something_else_drives_its_base() {
    let mut body = Simulator::new(Scene::by_name("demo", 1).unwrap(), SimConfig::default(), 1).unwrap();
    let mut robot = Robot::new(RobotConfig::default()).unwrap();
    let mut truths: Vec<Pose2> = Vec::new();
    while let Some(event) = body.next_event().unwrap() {
        let time = event.stamp().as_secs();
        let report = robot.step(&event);
        assert!(report.twist.is_none_or(|twist| twist == Twist2::ZERO), "{time} s: {:?}", report.twist);
        assert_eq!(report.state, DriveState::Idle, "{time} s");
        match event {
            SensorEvent::Truth { pose, .. } => truths.push(pose),
            SensorEvent::Wheels(_) => {
                // Straight, then a turn on the spot.
                let twist = if time < 4.0 { Twist2::new(0.2, 0.0) } else { Twist2::new(0.0, 0.5) };
                body.command(twist).unwrap();
            }
            _ => {}
        }
        if time > DRIVE_S {
            break;
        }
    }
    let truth = truths[0].inverse() * truths[truths.len() - 1];
    let error = robot.estimate().pose.inverse() * truth;
    println!("driven to {truth:?}, estimate off by {error:?}");
    assert!(truth.x > 0.7 && truth.theta > 1.5, "the base was driven: {truth:?}");
    assert!(error.position().norm() < 0.03 && error.theta.abs() < 0.03, "{error:?}");
    let free = robot.grid().cells().iter().filter(|cell| **cell == Cell::Free).count();
    assert!(free > 2000, "{free} free cells");
}

//! Your own robot: a body behind `RobotBody` with its own dimensions. `cargo run --release --example 08_your_own_robot`
//! runs it. The example's body is a model whose wheels have no noise. Replace `MyRobot` by the driver of your base and camera.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::{convert::Infallible, error::Error};
use trundle::core::{DifferentialDrive, GyroRate, Pose2, RobotBody, SensorEvent, Stamp, Twist2, WheelTicks};
use trundle::runtime::{Robot, RobotConfig};

/// Time between two readings of wheels and gyro \[s\]: 50 Hz. Source: ours.
const PERIOD_S: f64 = 0.02;
/// Dimensions of the base. Source: ours, an example.
const DRIVE: DifferentialDrive =
    DifferentialDrive { wheel_radius: 0.04, wheelbase: 0.30, ticks_per_turn: 4096.0 };

/// A base that follows each command exactly. The driver of a real base reads its serial port here.
#[derive(Default)]
struct MyRobot {
    twist: Twist2,
    /// Number of events so far: a gyro rate and wheel ticks in turn.
    events: u32,
    /// Distance driven by the left and the right wheel \[m\].
    driven: [f64; 2],
}

impl RobotBody for MyRobot {
    type Error = Infallible;

    fn next_event(&mut self) -> Result<Option<SensorEvent>, Infallible> {
        let stamp = Stamp::default().after(f64::from(self.events / 2) * PERIOD_S);
        self.events += 1;
        if self.events % 2 == 1 {
            return Ok(Some(SensorEvent::Gyro(GyroRate { stamp, omega: self.twist.omega })));
        }
        let (left, right) = DRIVE.wheel_speeds(self.twist);
        self.driven[0] += left * PERIOD_S;
        self.driven[1] += right * PERIOD_S;
        let [left, right] = self.driven.map(|m| (m / DRIVE.metres_per_tick()).round() as i64 as u16);
        Ok(Some(SensorEvent::Wheels(WheelTicks { stamp, left, right })))
    }

    fn command(&mut self, twist: Twist2) -> Result<(), Infallible> {
        self.twist = twist;
        Ok(())
    }
}

/// Runs the robot for 2 s. Without a camera the robot stands: the safety monitor requires an image first.
pub fn main() -> Result<(), Box<dyn Error>> {
    let (mut body, mut config) = (MyRobot::default(), RobotConfig::default());
    config.drive = DRIVE;
    let mut robot = Robot::new(config)?;
    robot.drive_to(Pose2::new(1.0, 0.0, 0.0))?;
    while let Some(event) = body.next_event()?.filter(|_| body.events < 200) {
        let Some(twist) = robot.step(&event).twist else { continue };
        body.command(twist)?;
    }
    assert_eq!(body.twist, Twist2::ZERO, "a robot without sight stands");
    println!("it stands, and its task is {:?}", robot.task());
    Ok(())
}

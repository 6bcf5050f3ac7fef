//! Your own robot: a body behind `RobotBody` with its own dimensions.
//!
//! `cargo run --release --example 08_your_own_robot`. The example's body is a model whose wheels have no noise. Replace `MyRobot` by the
//! driver of your base and camera.

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::convert::Infallible;
use std::error::Error;
use trundle::core::{DifferentialDrive, GyroRate, Pose2, RobotBody, SensorEvent, Stamp, Twist2, WheelTicks};
use trundle::runtime::{Robot, RobotConfig};

/// Time between two readings of wheels and gyro \[s\]: 50 Hz. Source: ours.
const PERIOD_S: f64 = 0.02;
/// Time after which this example ends \[s\]. Source: ours.
const DURATION_S: f64 = 2.0;

/// A base that follows each command exactly. The driver of a real base reads its serial port here.
struct MyRobot {
    drive: DifferentialDrive,
    twist: Twist2,
    time: f64,
    /// Rotation of the left and the right wheel \[ticks\].
    ticks: [f64; 2],
    gyro_is_next: bool,
}

impl RobotBody for MyRobot {
    type Error = Infallible;

    fn next_event(&mut self) -> Result<Option<SensorEvent>, Infallible> {
        let stamp = Stamp::default().after(self.time);
        if self.gyro_is_next {
            self.gyro_is_next = false;
            return Ok(Some(SensorEvent::Gyro(GyroRate { stamp, omega: self.twist.omega })));
        }
        self.time += PERIOD_S;
        let half = self.drive.wheelbase / 2.0;
        let ticks_per_m = self.drive.ticks_per_turn / (std::f64::consts::TAU * self.drive.wheel_radius);
        let speeds = [self.twist.v - half * self.twist.omega, self.twist.v + half * self.twist.omega];
        for (ticks, speed) in self.ticks.iter_mut().zip(speeds) {
            *ticks += speed * PERIOD_S * ticks_per_m;
        }
        self.gyro_is_next = true;
        let [left, right] = self.ticks.map(|ticks| ticks.round() as i64 as u16);
        let stamp = Stamp::default().after(self.time);
        Ok((self.time < DURATION_S).then_some(SensorEvent::Wheels(WheelTicks { stamp, left, right })))
    }

    fn command(&mut self, twist: Twist2) -> Result<(), Infallible> {
        self.twist = twist;
        Ok(())
    }
}

/// Runs the robot. Without a camera the robot does not move: the safety monitor requires an image first and reports its absence.
///
/// # Errors
/// When the robot is not valid.
pub fn run() -> Result<(), Box<dyn Error>> {
    let drive = DifferentialDrive { wheel_radius: 0.04, wheelbase: 0.30, ticks_per_turn: 4096.0 };
    let mut body = MyRobot { drive, twist: Twist2::ZERO, time: 0.0, ticks: [0.0; 2], gyro_is_next: false };
    let mut config = RobotConfig::default();
    config.drive = drive;
    let mut robot = Robot::new(config)?;
    robot.drive_to(Pose2::new(1.0, 0.0, 0.0))?;
    while let Some(event) = body.next_event()? {
        if let Some(twist) = robot.step(&event).twist {
            body.command(twist)?;
        }
    }
    println!("it stands, and its task is {:?}", robot.task());
    assert_eq!(body.twist, Twist2::ZERO, "a robot without sight stands");
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    run()
}

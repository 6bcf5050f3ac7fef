//! The robot of the BARN challenge: a Clearpath Jackal with a 2-D laser, and its simulated body.

use crate::laser_run::hokuyo;
use crate::simulated::simulated_body;
use trundle_core::{DifferentialDrive, DriveLimits, Hypotenuse, Invalid};
use trundle_runtime::{RangeSource, RobotConfig};
use trundle_sim::{FaultSchedule, SimConfig};

/// Half of the robot's length and width, m. Source: the Jackal's data sheet.
const HALF_SIZE_M: (f64, f64) = (0.254, 0.215);
/// Commanded acceleration, m/s^2; the robot's own controller allows 20. Source: ours.
const ACCELERATION_M_S2: f64 = 3.0;

/// The challenge's robot, a Clearpath Jackal, as configured for the autonomy: two-wheeled, 2 m/s, 0.508 x 0.430 m, a laser.
pub fn robot() -> RobotConfig {
    let (x, y) = HALF_SIZE_M;
    let mut robot = RobotConfig::default();
    robot.footprint_radius = x.hypotenuse(y);
    robot.footprint = Some(vec![[x, y], [-x, y], [-x, -y], [x, -y]]);
    robot.sight = RangeSource::Laser;
    robot.drive = DifferentialDrive { wheel_radius: 0.098, wheelbase: 0.3765, ..DifferentialDrive::KOBUKI };
    robot.limits = DriveLimits {
        wheel_speed: 2.4,
        v: 2.0,
        omega: 4.0,
        acceleration: ACCELERATION_M_S2,
        angular_acceleration: 10.0,
    };
    robot.schedule.map_hz = 20.0;
    robot.schedule.check_hz = 20.0;
    robot.schedule.improve_hz = 4.0;
    robot.odometry.max_speed = 5.0;
    robot.mapping.max_range = 10.0;
    // The laser covers the floor ahead, and the robot stops from this speed within 0.2 m.
    robot.planning.timing.slow_speed = 0.5;
    robot.planning.timing.unknown_speed = 1.0;
    robot.control.wait_from = 0.1;
    robot.control.wait_at = 0.3;
    robot.safety.deceleration = ACCELERATION_M_S2;
    robot.safety.angular_deceleration = 10.0;
    robot.safety.latency = 0.08;
    robot.safety.slow_margin = 0.02;
    robot.safety.creep_speed = 0.4;
    // Long enough for the gyro's bias; the laser's first scan is a sufficient view.
    robot.mission_executor.opening = 0.6;
    robot
}

/// Simulated body of the robot.
pub fn body(robot: &RobotConfig) -> Result<SimConfig, Invalid> {
    let mut config = simulated_body(robot, FaultSchedule::default())?;
    config.has_camera = false;
    config.laser = Some(hokuyo(0.12));
    config.kobuki.wheel_speed = robot.limits.wheel_speed;
    config.kobuki.wheel_acceleration = 2.0 * ACCELERATION_M_S2;
    config.kobuki.cliff_sensors = Vec::new();
    config.kobuki.height = 0.35;
    config.validated()
}

//! Odometry that a base computed, as events of a robot.

use super::continuous_odometry::{ContinuousOdometry, OdometryJump};
use super::wheels_from_odometry::WheelsFromOdometry;
use trundle_core::{DifferentialDrive, Odometry, SensorEvent};

/// Turns odometry that a base computed into events, without jumps: odometry, or wheels for a robot with a gyro, whose heading is the
/// gyro's. A ROS 2 robot and a bag of one have the same events.
#[derive(Debug, Clone)]
pub struct OdometryEvents {
    continuous: ContinuousOdometry,
    wheels: WheelsFromOdometry,
}

impl OdometryEvents {
    /// The events of a base with this drive.
    #[must_use]
    pub fn new(drive: DifferentialDrive) -> Self {
        Self { continuous: ContinuousOdometry::default(), wheels: WheelsFromOdometry::new(drive) }
    }

    /// The event of new odometry, and the jump before it if there is one. `uses_gyro`: whether the heading is the gyro's.
    pub fn add(&mut self, odometry: &Odometry, uses_gyro: bool) -> (SensorEvent, Option<OdometryJump>) {
        let (odometry, jump) = self.continuous.add(odometry);
        let event = match uses_gyro {
            true => SensorEvent::Wheels(self.wheels.add(&odometry)),
            false => SensorEvent::Odometry(odometry),
        };
        (event, jump)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;
    use trundle_core::{Pose2, Stamp, Twist2};

    #[test]
    fn odometry_is_wheels_with_a_gyro_and_itself_without() {
        let odometry = |x| {
            let (stamp, twist, covariance) = (Stamp::default(), Twist2::ZERO, Matrix3::zeros());
            Odometry { stamp, pose: Pose2::new(x, 0.0, 0.0), twist, covariance }
        };
        let drive = DifferentialDrive::KOBUKI;
        let mut plain = OdometryEvents::new(drive);
        assert_eq!(plain.add(&odometry(1.0), false), (SensorEvent::Odometry(odometry(1.0)), None));
        let mut events = OdometryEvents::new(drive);
        events.add(&odometry(1.0), true);
        let (SensorEvent::Wheels(ticks), None) = events.add(&odometry(1.25), true) else {
            panic!("no wheels")
        };
        assert_eq!(ticks.left, (0.25 / drive.metres_per_tick()) as u16);
        let (SensorEvent::Wheels(again), Some(jump)) = events.add(&odometry(5.25), true) else {
            panic!("a jump")
        };
        assert_eq!((again.left, jump), (ticks.left, OdometryJump(4.0)));
        assert!(jump.to_string().starts_with("a jump of 4.00 m from one message to the next"), "{jump}");
    }
}

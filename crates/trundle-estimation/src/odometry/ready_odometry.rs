//! Odometry computed by the body, as increments of the robot's odometry.
//!
//! Problem: a body restarts its odometry at any pose, and its stamps may jump. Idea: only the motion between two readings is used, with the
//! checks of a wheel reading. A reading from the past, after a gap, or with too high a speed does not move the pose. The covariance grows
//! as the body's covariance; if that does not grow, by the noise of wheels without a gyro. Cost: O(1).

use super::wheel_odometry::WheelOdometry;
use crate::odometry::report::WheelReport;
use crate::odometry_noise::{Step, of_gap, of_step};
use crate::planar::{transported, without_negative_variances};
use nalgebra::Matrix3;
use trundle_core::{Odometry, Pose2, Twist2};

/// Motion of the body between two readings of its odometry.
struct Increment {
    motion: Pose2,
    covariance: Matrix3<f64>,
    dt: f64,
}

impl Increment {
    fn between(last: &Odometry, new: &Odometry) -> Self {
        let motion = last.pose.inverse() * new.pose;
        let grown = new.covariance - transported(&last.covariance, &motion);
        Self { motion, covariance: without_negative_variances(grown), dt: new.stamp - last.stamp }
    }

    /// Speed of the faster wheel \[m/s\].
    fn wheel_speed(&self, half_base: f64) -> f64 {
        (self.motion.position().norm() + half_base * self.motion.theta.abs()) / self.dt
    }
}

impl WheelOdometry {
    /// Adds odometry computed by the body; returns the odometry after it, in a frame that never jumps. The body's pose, twist and
    /// covariance must be finite.
    pub fn step_odometry(&mut self, given: &Odometry) -> Odometry {
        let report = match self.last.given.replace(*given) {
            None => {
                self.odometry.stamp = given.stamp;
                WheelReport::Started
            }
            Some(last) if given.stamp <= last.stamp => {
                self.last.given = Some(last);
                WheelReport::TimeWentBack { by: last.stamp - given.stamp }
            }
            Some(last) => self.add_increment(given, &Increment::between(&last, given)),
        };
        self.reports.add(report);
        self.odometry
    }

    fn add_increment(&mut self, given: &Odometry, increment: &Increment) -> WheelReport {
        let half_base = self.drive.wheelbase / 2.0;
        self.odometry.stamp = given.stamp;
        let speed = increment.wheel_speed(half_base);
        if increment.dt > self.config.max_gap || speed > self.config.max_speed {
            self.odometry.twist = Twist2::ZERO;
            self.odometry.covariance += of_gap(&self.config, increment.dt);
            let is_gap = increment.dt > self.config.max_gap;
            return if is_gap { WheelReport::Gap { length: increment.dt } } else { WheelReport::Restarted };
        }
        let motion = increment.motion;
        let distance = motion.position().norm();
        let unobserved =
            self.wheel_fault.step(half_base, distance > 0.0 || motion.theta != 0.0, increment.dt);
        let step = Step { distance, turn: motion.theta, dt: increment.dt, by_gyro: None, slip: 0.0 };
        let by_wheels = of_step(&self.config, &step);
        let grows = (0..3).all(|i| increment.covariance[(i, i)] > 0.0);
        let noise = if grows { increment.covariance } else { by_wheels };
        self.path_length += distance;
        let odometry = &mut self.odometry;
        odometry.pose = odometry.pose * motion;
        odometry.twist = given.twist;
        odometry.covariance = transported(&odometry.covariance, &motion) + noise;
        odometry.covariance += unobserved.covariance(false);
        WheelReport::Used
    }
}

#[cfg(test)]
mod tests {
    use crate::{OdometryConfig, WheelOdometry, WheelReport};
    use nalgebra::Matrix3;
    use trundle_core::{DifferentialDrive, Odometry, Pose2, Stamp, Twist2, Vector3};

    fn own() -> WheelOdometry {
        WheelOdometry::new(DifferentialDrive::KOBUKI, OdometryConfig::default()).unwrap()
    }

    fn given(time: f64, pose: Pose2, variance: f64) -> Odometry {
        let covariance = Matrix3::from_diagonal_element(variance);
        Odometry { stamp: Stamp::default().after(time), pose, twist: Twist2::new(0.2, 0.1), covariance }
    }

    fn arc(i: i32) -> Pose2 {
        Pose2::exp(Vector3::new(0.01 * f64::from(i), 0.0, 0.005 * f64::from(i)))
    }

    #[test]
    fn motion_is_followed_from_any_pose_and_through_a_restart_of_the_body() {
        let (mut own, origin) = (own(), Pose2::new(7.0, -3.0, 2.0));
        for i in 0..=50 {
            own.step_odometry(&given(0.05 * f64::from(i), origin * arc(i), 1e-6 * f64::from(i)));
        }
        let before = own.odometry().pose;
        assert!(before.distance(&arc(50)) < 1e-9 && (before.theta - arc(50).theta).abs() < 1e-9);
        let sigma = own.odometry().covariance[(0, 0)];
        own.step_odometry(&given(2.55, Pose2::IDENTITY, 0.0));
        assert_eq!(own.report(), WheelReport::Restarted);
        assert_eq!(own.odometry().pose, before);
        assert!(own.odometry().covariance[(0, 0)] > sigma, "the motion of the restart is unknown");
        own.step_odometry(&given(2.60, arc(1), 1e-6));
        assert!((before.inverse() * own.odometry().pose).distance(&arc(1)) < 1e-9);
    }

    #[test]
    fn odometry_from_the_past_or_after_a_gap_does_not_move_the_pose() {
        let mut own = own();
        own.step_odometry(&given(1.0, arc(0), 0.0));
        own.step_odometry(&given(0.9, arc(40), 0.0));
        assert!(matches!(own.report(), WheelReport::TimeWentBack { .. }));
        own.step_odometry(&given(9.0, arc(40), 0.0));
        assert!(matches!(own.report(), WheelReport::Gap { .. }));
        assert_eq!(own.odometry().pose, Pose2::IDENTITY);
    }

    #[test]
    fn the_covariance_is_the_bodys_where_it_grows_and_else_that_of_wheels() {
        let (mut growing, mut fixed) = (own(), own());
        for i in 0..=20 {
            let time = 0.05 * f64::from(i);
            growing.step_odometry(&given(
                time,
                Pose2::new(0.01 * f64::from(i), 0.0, 0.0),
                4e-4 * f64::from(i),
            ));
            fixed.step_odometry(&given(time, Pose2::new(0.01 * f64::from(i), 0.0, 0.0), 1e-3));
        }
        assert!((growing.odometry().covariance[(0, 0)] - 8e-3).abs() < 1e-9);
        let wheels = OdometryConfig::default().by_wheels(&Pose2::new(0.2, 0.0, 0.0))[(0, 0)];
        assert!((fixed.odometry().covariance[(0, 0)] / wheels - 1.0).abs() < 0.05);
    }
}

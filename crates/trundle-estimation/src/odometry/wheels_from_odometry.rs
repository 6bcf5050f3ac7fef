//! Conversion of odometry to wheel readings, for a robot with a gyro: the heading is the gyro's.

use trundle_core::{DifferentialDrive, Odometry, Pose2, WheelTicks};

/// Turns poses of odometry into counters of two wheels.
#[derive(Debug, Clone)]
pub struct WheelsFromOdometry {
    drive: DifferentialDrive,
    last: Option<Pose2>,
    /// Travel of the left and right wheel \[ticks\].
    travel: [f64; 2],
}

/// Turn below which an arc has the length of its chord \[rad\]. Source: ours; the difference is below 1e-12.
const MIN_TURN_RAD: f64 = 1e-6;

impl WheelsFromOdometry {
    /// Counters of the wheels of `drive`.
    #[must_use]
    pub fn new(drive: DifferentialDrive) -> Self {
        Self { drive, last: None, travel: [0.0; 2] }
    }

    /// The counters after new odometry. The odometry must have no jumps.
    pub fn add(&mut self, odometry: &Odometry) -> WheelTicks {
        let motion = self.last.map_or(Pose2::IDENTITY, |last| last.inverse() * odometry.pose);
        self.last = Some(odometry.pose);
        let turn = motion.theta * self.drive.wheelbase / 2.0;
        // The direction of an arc's chord differs from the heading by half the turn, and the chord is shorter than the arc.
        let half = motion.theta / 2.0;
        let chord = motion.position().dot(&Pose2::new(0.0, 0.0, half).direction());
        let ahead = if half.abs() > MIN_TURN_RAD { chord * half / half.sin() } else { chord };
        for (travel, distance) in self.travel.iter_mut().zip([ahead - turn, ahead + turn]) {
            *travel += distance / self.drive.metres_per_tick();
        }
        let [left, right] = self.travel.map(|travel| (travel.floor() as i64) as u16);
        WheelTicks { stamp: odometry.stamp, left, right }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;
    use trundle_core::{Stamp, Twist2};

    #[test]
    fn an_arc_there_and_back_leaves_the_counters_as_they_were() {
        let mut wheels = WheelsFromOdometry::new(DifferentialDrive::KOBUKI);
        let odometry = |pose| Odometry {
            stamp: Stamp::default(),
            pose,
            twist: Twist2::ZERO,
            covariance: Matrix3::zeros(),
        };
        wheels.add(&odometry(Pose2::IDENTITY));
        let drive = DifferentialDrive::KOBUKI;
        let pose = Pose2::IDENTITY.advance(Twist2::new(0.3, 0.8), 0.5);
        let ticks = wheels.add(&odometry(pose));
        let (left, right) = drive.wheel_speeds(Twist2::new(0.3, 0.8));
        let expected = [left, right].map(|speed| speed * 0.5 / drive.metres_per_tick());
        assert!((f64::from(ticks.left) - expected[0]).abs() < 1.5, "{ticks:?} {expected:?}");
        assert!((f64::from(ticks.right) - expected[1]).abs() < 1.5, "{ticks:?} {expected:?}");
        let back = wheels.add(&odometry(Pose2::IDENTITY));
        assert!([back.left, back.right].iter().all(|ticks| ticks.wrapping_add(1) <= 2), "{back:?}");
    }
}

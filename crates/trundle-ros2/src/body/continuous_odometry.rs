//! Odometry that continues after a restart of the base's driver.

use trundle_core::{Odometry, Pose2};

/// Motion between two messages that is a restart of the odometry \[m\]. Source: ours; 10 m/s at 20 Hz.
pub const MAX_STEP_M: f64 = 0.5;

/// Takes jumps out of odometry: a jump is not motion.
#[derive(Debug, Default)]
pub struct ContinuousOdometry {
    /// The newest pose as received, and without jumps.
    newest: Option<(Pose2, Pose2)>,
}

impl ContinuousOdometry {
    /// The odometry without jumps, and the length of this jump \[m\] if it is one.
    pub fn add(&mut self, odometry: &Odometry) -> (Odometry, Option<f64>) {
        let Some((raw, smooth)) = self.newest else {
            self.newest = Some((odometry.pose, odometry.pose));
            return (*odometry, None);
        };
        let motion = raw.inverse() * odometry.pose;
        let length = motion.position().norm();
        let is_jump = length > MAX_STEP_M;
        let pose = if is_jump { smooth } else { smooth * motion };
        self.newest = Some((odometry.pose, pose));
        (Odometry { pose, ..*odometry }, is_jump.then_some(length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;
    use trundle_core::{Stamp, Twist2};

    #[test]
    fn a_jump_is_not_motion_and_the_next_step_counts() {
        let mut continuous = ContinuousOdometry::default();
        let mut at = |x| {
            let (stamp, twist, covariance) = (Stamp::default(), Twist2::ZERO, Matrix3::zeros());
            let (odometry, jump) =
                continuous.add(&Odometry { stamp, pose: Pose2::new(x, 0.0, 0.0), twist, covariance });
            (odometry.pose.x, jump)
        };
        assert_eq!(at(1.0), (1.0, None));
        assert_eq!(at(1.25), (1.25, None));
        assert_eq!(at(0.0), (1.25, Some(1.25)));
        assert_eq!(at(0.25), (1.5, None));
    }
}

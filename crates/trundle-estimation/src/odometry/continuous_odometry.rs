//! Odometry that continues after a restart of the base's driver.

use std::fmt;
use trundle_core::{Odometry, Pose2};

/// Motion between two messages above which the odometry has restarted \[m\]. Source: ours; 10 m/s at 20 Hz.
const MAX_STEP_M: f64 = 0.5;

/// A restart of the odometry: its length \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OdometryJump(pub f64);

impl fmt::Display for OdometryJump {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "a jump of {:.2} m from one message to the next, expected at most {MAX_STEP_M} m: was the base's driver started anew?",
            self.0
        )
    }
}

/// Takes jumps out of odometry: a jump is not motion.
#[derive(Debug, Clone, Default)]
pub struct ContinuousOdometry {
    /// The newest pose as received, and without jumps.
    newest: Option<(Pose2, Pose2)>,
}

impl ContinuousOdometry {
    /// The odometry without jumps, and this jump if it is one.
    pub fn add(&mut self, odometry: &Odometry) -> (Odometry, Option<OdometryJump>) {
        let Some((raw, smooth)) = self.newest else {
            self.newest = Some((odometry.pose, odometry.pose));
            return (*odometry, None);
        };
        let motion = raw.inverse() * odometry.pose;
        let length = motion.position().norm();
        let is_jump = length > MAX_STEP_M;
        let pose = if is_jump { smooth } else { smooth * motion };
        self.newest = Some((odometry.pose, pose));
        (Odometry { pose, ..*odometry }, is_jump.then_some(OdometryJump(length)))
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
        assert_eq!(at(0.0), (1.25, Some(OdometryJump(1.25))));
        assert_eq!(at(0.25), (1.5, None));
    }
}

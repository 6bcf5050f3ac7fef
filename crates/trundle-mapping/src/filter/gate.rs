use super::{
    ParticleConfig, Refusal,
    motion::{motion_covariance, unknown_motion_covariance},
};
use nalgebra::Matrix3;
use trundle_core::{Pose2, Scan, Stamp};

/// Farther from its origin no odometry tells of anything true, m.
const FARTHEST: f64 = 1e6;

/// Which scans are looked at: those after some motion or time.
#[derive(Debug, Clone, Default)]
pub(crate) struct Gate {
    /// The last scan that was processed.
    pub(crate) last: Option<Last>,
}

/// When and where by the odometry.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Last {
    pub(crate) stamp: Stamp,
    pub(crate) odom_from_base: Pose2,
}

/// What the odometry says since the last processed scan.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub(crate) first: bool,
    pub(crate) motion: Pose2,
    /// m, m, rad, in the base's frame.
    pub(crate) covariance: Matrix3<f64>,
    /// It jumped: it says nothing.
    pub(crate) jumped: bool,
}

impl Gate {
    /// The step to a scan that is to be processed; `None` when the robot has hardly moved.
    pub(crate) fn pass(
        &mut self,
        config: &ParticleConfig,
        odom_from_base: Pose2,
        scan: &Scan,
    ) -> Result<Option<Step>, Refusal> {
        if !odom_from_base.is_finite() {
            return Err(Refusal::NotFinite);
        }
        if odom_from_base.position().amax() > FARTHEST {
            return Err(Refusal::OutOfReach);
        }
        let now = Last { stamp: scan.stamp(), odom_from_base };
        let Some(last) = self.last else {
            self.last = Some(now);
            let covariance = motion_covariance(&config.motion, Pose2::IDENTITY);
            return Ok(Some(Step { first: true, motion: Pose2::IDENTITY, covariance, jumped: false }));
        };
        if scan.stamp() < last.stamp {
            return Err(Refusal::TimeGoesBack);
        }
        let motion = last.odom_from_base.inverse() * odom_from_base;
        let still = scan.stamp() - last.stamp < config.wait_gate
            && motion.position().norm() < config.move_gate
            && motion.theta.abs() < config.turn_gate_deg.to_radians();
        if still {
            return Ok(None);
        }
        let way = motion.position().norm();
        let jumped = way > config.jump;
        if config.pose_prior.is_some() && way > config.jump * (scan.stamp() - last.stamp).max(1.0) {
            return Err(Refusal::OutOfReach);
        }
        self.last = Some(now);
        let (motion, covariance) = if jumped {
            (Pose2::IDENTITY, unknown_motion_covariance())
        } else {
            (motion, motion_covariance(&config.motion, motion))
        };
        Ok(Some(Step { first: false, motion, covariance, jumped }))
    }
}

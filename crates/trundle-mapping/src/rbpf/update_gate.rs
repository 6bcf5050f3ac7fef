//! Choice of the scans to process, and checks of the odometry.

use crate::particle_config::ParticleConfig;
use crate::rbpf::motion_model::{motion_covariance, silent_motion_covariance, unknown_motion_covariance};
use crate::rbpf::scan_difference::ScanRanges;
use crate::rbpf::scan_update::Refusal;
use nalgebra::Matrix3;
use trundle_core::{Pose2, Scan, Stamp};

/// Maximum distance of the odometry from its origin \[m\]. A farther pose is refused. Source: ours.
const MAX_ODOMETRY_DISTANCE_M: f64 = 1e6;

/// Selects the scans to process: after some motion or time, or, without odometry motion, if the scan differs.
#[derive(Debug, Clone, Default)]
pub(crate) struct UpdateGate {
    /// The last scan that was processed.
    pub(crate) last: Option<LastScan>,
    /// The ranges of that scan.
    ranges: ScanRanges,
    /// A refused far pose, and the number of successive poses that agree with it.
    doubted: Option<(LastScan, usize)>,
}

/// Number of successive implausible poses that agree with each other after which the odometry's frame counts as moved.
/// Source: ours.
const MIN_AGREEING_POSES: usize = 5;

/// Stamp and pose of a scan by the odometry.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LastScan {
    pub(crate) stamp: Stamp,
    pub(crate) odom_from_base: Pose2,
}

impl LastScan {
    /// Whether `there` is too far for a robot of `jump` m/s.
    fn is_out_of_reach(&self, there: &Self, jump: f64) -> bool {
        let distance = self.odom_from_base.distance(&there.odom_from_base);
        distance > jump * (there.stamp - self.stamp).max(1.0)
    }
}

/// Step of the odometry since the last processed scan.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OdometryStep {
    pub(crate) first: bool,
    pub(crate) motion: Pose2,
    /// Covariance: m, m, rad, in the base's frame.
    pub(crate) covariance: Matrix3<f64>,
    /// Whether the odometry jumped; the step is then unknown.
    pub(crate) jumped: bool,
    /// Whether the odometry did not move while the scans differ: no odometry, or a pushed robot.
    pub(crate) silent: bool,
}

impl UpdateGate {
    /// The step to a scan to be processed; `None` if the robot has hardly moved. With absolute poses, a pose that is too far away is
    /// refused.
    pub(crate) fn pass(
        &mut self,
        config: &ParticleConfig,
        poses_count: bool,
        odom_from_base: Pose2,
        scan: &Scan,
    ) -> Result<Option<OdometryStep>, Refusal> {
        if !odom_from_base.is_finite() {
            return Err(Refusal::NotFinite);
        }
        if odom_from_base.position().amax() > MAX_ODOMETRY_DISTANCE_M {
            return Err(Refusal::OutOfReach);
        }
        let now = LastScan { stamp: scan.stamp(), odom_from_base };
        let Some(last) = self.last else {
            self.take(now, scan);
            let covariance = motion_covariance(&config.motion, Pose2::IDENTITY);
            return Ok(Some(OdometryStep {
                first: true,
                motion: Pose2::IDENTITY,
                covariance,
                jumped: false,
                silent: false,
            }));
        };
        if scan.stamp() < last.stamp {
            return Err(Refusal::TimeGoesBack);
        }
        if poses_count && self.is_wild(&last, now, config.jump) {
            return Err(Refusal::OutOfReach);
        }
        let motion = last.odom_from_base.inverse() * odom_from_base;
        let still = scan.stamp() - last.stamp < config.wait_gate
            && motion.position().norm() < config.move_gate
            && motion.theta.abs() < config.turn_gate_deg.to_radians();
        let silent = now.odom_from_base == last.odom_from_base
            && !poses_count
            && self.ranges.differ_from(config, scan);
        if still && !silent {
            return Ok(None);
        }
        let jumped = motion.position().norm() > config.jump;
        self.take(now, scan);
        let covariance = match (jumped, silent) {
            (true, _) => unknown_motion_covariance(),
            (false, true) => silent_motion_covariance(),
            (false, false) => motion_covariance(&config.motion, motion),
        };
        let motion = if jumped && !poses_count { Pose2::IDENTITY } else { motion };
        Ok(Some(OdometryStep { first: false, motion, covariance, jumped, silent }))
    }

    fn take(&mut self, now: LastScan, scan: &Scan) {
        self.last = Some(now);
        self.ranges = ScanRanges::of(scan);
    }

    /// Whether a pose is too far for the robot's speed, and too few successive poses agree with it.
    fn is_wild(&mut self, last: &LastScan, now: LastScan, jump: f64) -> bool {
        let doubted = self.doubted.take();
        if !last.is_out_of_reach(&now, jump) {
            return false;
        }
        let reported = doubted.filter(|(wild, _)| !wild.is_out_of_reach(&now, jump));
        let times = 1 + reported.map_or(0, |(_, times)| times);
        self.doubted = (times < MIN_AGREEING_POSES).then_some((now, times));
        times < MIN_AGREEING_POSES
    }
}

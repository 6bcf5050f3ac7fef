use super::{TrackingConfig, TrackingError, law::tracking_law};
use crate::Limiter;
use trundle_core::{DifferentialDrive, DriveLimits, Invalid, PoseEstimate, TrajectoryPoint, Twist2};

/// Drives the base along a moving reference by the law of A6, within the limits of the base.
///
/// Once the reference stands, the error beside it is no longer regulated: that is for [`Stabilizer`](crate::Stabilizer).
#[derive(Debug, Clone, PartialEq)]
pub struct Tracker {
    config: TrackingConfig,
    limiter: Limiter,
}

/// One step of tracking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControlReport {
    /// The twist to send.
    pub twist: Twist2,
    /// Where the reference is, seen from the robot.
    pub error: TrackingError,
    /// Whether a limit of the base changed what the law wanted.
    pub saturated: bool,
}

impl Tracker {
    /// A tracker for a base at rest.
    ///
    /// # Errors
    /// When a number of the configuration, the drive or the limits is outside its range.
    pub fn new(
        config: TrackingConfig,
        drive: DifferentialDrive,
        limits: DriveLimits,
    ) -> Result<Self, Invalid> {
        Ok(Self { config: config.validated()?, limiter: Limiter::new(drive, limits)? })
    }

    /// Says what the base was really asked for, where that is not the last twist reported.
    pub fn sent(&mut self, twist: Twist2) {
        self.limiter.sent(twist);
    }

    /// The command for now, `dt` seconds after the last one; poses of estimate and reference in one frame.
    pub fn step(&mut self, estimate: &PoseEstimate, reference: &TrajectoryPoint, dt: f64) -> ControlReport {
        let error = TrackingError::between(estimate.pose, reference.pose);
        let wanted = tracking_law(error, reference.twist, self.config.gains(reference.twist));
        let limited = self.limiter.limit(wanted, dt);
        ControlReport { twist: limited.twist, error, saturated: limited.saturated }
    }
}

//! The tracking law within the limits of the base.

use crate::limiter::Limiter;
use crate::path_tracking::path_tracking_config::PathTrackingConfig;
use crate::path_tracking::tracking_error::TrackingError;
use crate::path_tracking::tracking_law::tracking_law;
use trundle_core::{DifferentialDrive, DriveLimits, Invalid, PoseEstimate, TrajectoryPoint, Twist2};

/// Drives the base along a moving reference by the law of A6, within the limits of the base.
///
/// When the reference is at rest, its lateral error is not regulated: [`Stabilizer`](crate::Stabilizer) does that.
#[derive(Debug, Clone, PartialEq)]
pub struct PathTracker {
    config: PathTrackingConfig,
    limiter: Limiter,
}

/// Result of one control step of tracking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackingReport {
    /// The twist to send.
    pub twist: Twist2,
    /// Error to the reference in the robot's frame.
    pub error: TrackingError,
    /// Whether a limit of the base changed the law's command.
    pub saturated: bool,
}

impl PathTracker {
    /// A tracker for a base at rest.
    ///
    /// # Errors
    /// When a number of the configuration, the drive or the limits is outside its range.
    pub fn new(
        config: PathTrackingConfig,
        drive: DifferentialDrive,
        limits: DriveLimits,
    ) -> Result<Self, Invalid> {
        Ok(Self { config: config.validated()?, limiter: Limiter::new(drive, limits)? })
    }

    /// Sets the twist that was really sent, if it differs from the last one reported.
    pub fn sent(&mut self, twist: Twist2) {
        self.limiter.sent(twist);
    }

    /// The command for now, `dt` seconds after the last one; poses of estimate and reference in one frame.
    pub fn step(&mut self, estimate: &PoseEstimate, reference: &TrajectoryPoint, dt: f64) -> TrackingReport {
        let error = TrackingError::between(estimate.pose, reference.pose);
        let wanted = tracking_law(error, reference.twist, self.config.gains(reference.twist));
        let limited = self.limiter.limit(wanted, dt);
        TrackingReport { twist: limited.twist, error, saturated: limited.saturated }
    }
}

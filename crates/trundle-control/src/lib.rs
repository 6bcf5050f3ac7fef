//! From a trajectory and a pose to a twist: tracking, point stabilisation, limits, safe stop.
//!
//! [`Follower`] is the door: it drives along a trajectory with [`Tracker`] (docs/methods.md A6), its reference clock waiting
//! for the robot, and settles at the goal with [`Stabilizer`] (A7). [`SafetyMonitor`] comes after it, knows nothing of plans,
//! and lets only twists through from which the robot can still stop. Every command obeys [`Limiter`].
//! The laws, their gains and their limits stand in `docs/algorithms/control.md`.
//!
//! ```
//! use trundle_control::{Tracker, TrackingConfig};
//! use trundle_core::{DifferentialDrive, DriveLimits, Pose2, PoseEstimate, Stamp, TrajectoryPoint, Twist2};
//!
//! let mut tracker = Tracker::new(TrackingConfig::default(), DifferentialDrive::KOBUKI, DriveLimits::KOBUKI)?;
//! let estimate = PoseEstimate {
//!     stamp: Stamp::default(),
//!     pose: Pose2::IDENTITY,
//!     twist: Twist2::ZERO,
//!     covariance: nalgebra::Matrix3::zeros(),
//! };
//! let ahead = TrajectoryPoint { time: 0.0, pose: Pose2::new(0.1, 0.0, 0.0), twist: Twist2::new(0.3, 0.0) };
//! let report = tracker.step(&estimate, &ahead, 0.02);
//! assert!(report.twist.v > 0.0 && report.saturated); // it may not leap to 0.3 m/s in 20 ms
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

mod following;
mod limiter;
mod safety;
mod settling;
mod tracking;

pub use following::{FollowPhase, FollowReport, Follower, FollowerConfig};
pub use limiter::{Limited, Limiter};
pub use safety::{
    MotionSense, SafetyAction, SafetyConfig, SafetyInput, SafetyMemory, SafetyMonitor, SafetyReport,
    SafetyScan, SlowReason, StopReason,
};
pub use settling::{SettleConfig, SettlePreview, SettleReport, SettleState, Stabilizer};
pub use tracking::{ControlReport, Tracker, TrackingConfig, TrackingError};

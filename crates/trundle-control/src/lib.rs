//! From a trajectory and a pose to a twist: tracking, point stabilisation, limits, safe stop.
//!
//! Start with [`Follower`]. [`Follower`] follows a trajectory with [`PathTracker`] (docs/methods.md A6) and stabilises the goal pose with
//! [`Stabilizer`] (A7). The clock of the reference slows down if the robot falls behind. [`SafetyMonitor`] then checks each twist without
//! any plan, and passes only twists from which the robot can still stop. Every command keeps the limits of [`Limiter`].
//! `docs/algorithms/control.md` has the laws, their gains and their limits.
//!
//! ```
//! use trundle_control::{PathTracker, PathTrackingConfig};
//! use trundle_core::{DifferentialDrive, DriveLimits, Pose2, PoseEstimate, Stamp, TrajectoryPoint, Twist2};
//!
//! let mut tracker = PathTracker::new(PathTrackingConfig::default(), DifferentialDrive::KOBUKI, DriveLimits::KOBUKI)?;
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
mod path_tracking;
mod safety;
mod stabilization;

pub use following::follower::{FollowPhase, FollowReport, Follower};
pub use following::follower_config::FollowerConfig;
pub use limiter::{Limited, Limiter};
pub use path_tracking::path_tracker::{PathTracker, TrackingReport};
pub use path_tracking::path_tracking_config::PathTrackingConfig;
pub use path_tracking::tracking_error::TrackingError;
pub use safety::hold::MotionHold;
pub use safety::obstacles::{SafetyMemory, SafetyScan};
pub use safety::safety_action::{SafetyAction, SafetyReport, SlowReason, StopReason};
pub use safety::safety_config::SafetyConfig;
pub use safety::safety_input::{MotionSense, SafetyInput, is_stale};
pub use safety::safety_monitor::SafetyMonitor;
pub use safety::station_motion::StationMotion;
pub use stabilization::stabilizer::{Stabilizer, StabilizerPhase, StabilizerReport};
pub use stabilization::stabilizer_config::StabilizerConfig;
pub use stabilization::stabilizer_preview::StabilizerPreview;

//! From wheels, gyro, visual pose and scan match to one pose estimate.
//!
//! - [`WheelOdometry`]: encoder ticks and gyro to a continuous, drifting pose with honest covariance.
//! - [`Localizer`]: that odometry, corrected by visual poses and scan matches at the times they were taken, to the one
//!   [`trundle_core::PoseEstimate`] that planning and control use.
//! - [`Odometer`]: what that said at a moment: with [`trundle_core::CameraMotion::of_base`] the motion prior of visual tracking.
//!
//! ```
//! use trundle_core::{DifferentialDrive, GyroRate, Pose3, Stamp, Vector3, WheelTicks};
//! use trundle_localization::{Localizer, LocalizerConfig, OdometryConfig, WheelOdometry};
//!
//! let mut wheels = WheelOdometry::new(DifferentialDrive::KOBUKI, OdometryConfig::default())?;
//! let base_from_camera = Pose3::new(Default::default(), Vector3::new(0.05, 0.0, 0.45));
//! let mut localizer = Localizer::new(LocalizerConfig::default(), base_from_camera)?;
//! for i in 0..=50_u16 {
//!     let stamp = Stamp::from_nanos(i64::from(i) * 20_000_000);
//!     wheels.step_gyro(&GyroRate { stamp, omega: 0.0 });
//!     let odometry = wheels.step_wheels(&WheelTicks { stamp, left: i * 70, right: i * 70 });
//!     localizer.predict(&odometry);
//! }
//! let way = 50.0 * 70.0 * DifferentialDrive::KOBUKI.metres_per_tick();
//! assert!((localizer.estimate().pose.x - way).abs() < 1e-9);
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

mod belief;
mod camera_turns;
mod correction;
mod gyro_errors;
mod history;
mod learnt;
mod localizer;
mod localizer_config;
mod obedience;
mod odometer;
mod odometry_config;
mod odometry_noise;
mod planar;
mod recovery;
mod stuck_gyro;
mod turn_integral;
mod visual_frame;
mod wheel_odometry;
mod wheel_report;
mod wheel_size;

pub use correction::{Correction, Prediction, VisualPose, VisualQuality};
pub use localizer::Localizer;
pub use localizer_config::LocalizerConfig;
pub use odometer::Odometer;
pub use odometry_config::OdometryConfig;
pub use planar::planar_covariance;
pub use visual_frame::VisualAnchor;
pub use wheel_odometry::WheelOdometry;
pub use wheel_report::{WheelCounts, WheelReport};

//! Fusion of wheels, gyro, visual poses and scan matches to one pose estimate.
//!
//! - [`WheelOdometry`]: continuous pose by encoder ticks and gyro, with drift, and its covariance.
//! - [`OdometryEvents`]: odometry that a base computed, as events of a robot: wheels if a gyro gives the heading.
//! - [`Localizer`]: an extended Kalman filter on SE(2). It corrects the odometry by visual poses and scan matches at their stamps, and
//!   yields the [`trundle_core::PoseEstimate`] of planning and control.
//! - [`Smoother`]: poses of the last seconds and calibration by one least-squares problem, beside the localizer.
//! - [`fuse_frames`]: one trajectory of a recorded sequence from several visual maps and the odometry between them.
//! - [`StationEstimator`]: the pose of a charging station from its infrared light.
//! - [`OdometryState`]: pose and covariance of the odometry at a stamp. With [`trundle_core::CameraMotion::of_base`] it is the
//!   motion prior of visual tracking.
//! - [`estimate_image_delay`], [`FloorSearch`], [`fit_wheels_and_camera`], [`fit_gyro`]: calibration by a recording.
//!
//! ```
//! use trundle_core::{DifferentialDrive, GyroRate, Pose3, Stamp, Vector3, WheelTicks};
//! use trundle_estimation::{Localizer, LocalizerConfig, OdometryConfig, WheelOdometry};
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
//! let distance = 50.0 * 70.0 * DifferentialDrive::KOBUKI.metres_per_tick();
//! assert!((localizer.estimate().pose.x - distance).abs() < 1e-9);
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

mod calibration;
mod charging_station;
mod faults;
mod fusion;
mod odometry;
mod odometry_config;
mod odometry_noise;
mod planar;
mod pose_monitor;
mod smoother;
mod trajectory_fusion;

pub use calibration::batch::error::CalibrationError;
pub use calibration::batch::estimate::Estimate;
pub use calibration::batch::floor_plane::{FloorMount, FloorSearch, FloorView};
pub use calibration::batch::gyro_angle::GyroAngle;
pub use calibration::batch::gyro_fit::{GyroFit, fit_gyro};
pub use calibration::batch::image_delay::{ImageDelay, estimate_image_delay};
pub use calibration::batch::turn_axis::turn_axis;
pub use calibration::batch::wheel_angles::WheelAngles;
pub use calibration::batch::wheel_camera_fit::{WheelCameraFit, fit_wheels_and_camera};
pub use charging_station::{StationEstimate, StationEstimator, StationLightConfig};
pub use fusion::config::LocalizerConfig;
pub use fusion::correction::{Correction, Prediction, ScanPose, VisualPose, VisualQuality};
pub use fusion::localizer::Localizer;
pub use fusion::map_uncertainty::MapUncertainty;
pub use fusion::pose_uncertainty::PoseUncertainty;
pub use fusion::visual_frame::VisualAnchor;
pub use odometry::continuous_odometry::{ContinuousOdometry, OdometryJump};
pub use odometry::motion_increment::MotionIncrement;
pub use odometry::odometry_events::OdometryEvents;
pub use odometry::report::{WheelCounts, WheelReport};
pub use odometry::state::OdometryState;
pub use odometry::wheel_odometry::WheelOdometry;
pub use odometry::wheels_from_odometry::WheelsFromOdometry;
pub use odometry_config::OdometryConfig;
pub use planar::planar_covariance;
pub use pose_monitor::displacement::ImageEvidence;
pub use pose_monitor::monitor::{PoseMonitor, VisualEvidence, VisualVerdict};
pub use pose_monitor::visual_jump::PoseBelief;
pub use smoother::calibration::{SmootherCalibration, WithSigma};
pub use smoother::config::{SmootherConfig, SmootherLimits, SmootherNoise, WindowConfig};
pub use smoother::fixed_lag::Smoother;
pub use smoother::innovation::Innovation;
pub use smoother::measurement::{MeasurementUse, PlanarMeasurement};
pub use trajectory_fusion::frame::{MapPose, SequenceFrame};
pub use trajectory_fusion::fuse::fuse_frames;

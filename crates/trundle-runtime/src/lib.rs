//! The whole robot: loop, schedule, states, configuration.
//!
//! [`Robot`] is one value with one `step`: a sensor event in, a [`StepReport`] out. Only this crate connects SLAM, mapping, localization,
//! planning, control and docking, by core types. Time is that of the data: the stamps and the [`Schedule`] decide when each stage runs, so
//! a replayed recording gives the same reports.
//!
//! ```
//! use trundle_core::{SensorEvent, Stamp, WheelTicks};
//! use trundle_runtime::{Robot, RobotConfig};
//! let mut robot = Robot::new(RobotConfig::default())?;
//! let wheels = WheelTicks { stamp: Stamp::from_nanos(0), left: 0, right: 0 };
//! let report = robot.step(&SensorEvent::Wheels(wheels));
//! assert!(report.twist.is_none_or(|twist| twist.v == 0.0), "a robot without a goal rests");
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

mod behaviour;
mod bumper;
mod camera_mount;
mod checkpoint;
mod config;
mod global_localization;
mod goal_approach;
mod histogram;
mod lazy_image;
mod level_map;
mod mission;
mod monitors;
mod operator;
mod pose_status;
mod range_source;
pub mod real_time;
mod reason;
mod report;
mod robot;
mod scan_pose_log;
mod schedule;
pub mod settings;
mod stage;
mod workers;
mod world_state;
mod zones;

pub use behaviour::drive_state::DriveState;
pub use camera_mount::CameraMount;
pub use checkpoint::{Checkpoint, CheckpointError};
pub use config::RobotConfig;
pub use goal_approach::{ApproachEnd, ApproachFailure, GoalApproachConfig, GoalApproachReport};
pub use histogram::Histogram;
pub use lazy_image::LazyImage;
pub use level_map::{LevelMap, base_below, level_from_first_camera};
pub use mission::executor_config::MissionExecutorConfig;
pub use mission::{
    DockFailure, GoalOptions, Mission, MissionState, Task, TaskEnd, TaskGoal, TaskRecord, WhenBlocked,
};
pub use operator::{OperatorCommand, PoseGuess, RunSetting, RunSettings, TELEOP_SILENCE_S, require_loadable};
pub use range_source::RangeSource;
pub use reason::{NoPath, Reason, ReasonKind, TaskFailure, TransitionReason};
pub use report::{PoseMeasurements, StepReport};
pub use robot::{MissionProgress, Robot};
pub use schedule::Schedule;
pub use stage::{Stage, StageCost, StageTimes};
pub use trundle_control::MotionHold;
pub use workers::job::{Answer, Job, Worker};

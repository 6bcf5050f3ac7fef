//! The whole robot: the loop, its schedule, its states, its configuration.
//!
//! [`Robot`] is one value with one `step`: a sensor event in, a [`StepReport`] out. It is the only place where the rooms
//! (SLAM, mapping, localization, planning, control, docking) meet, as core types. It runs on the data's time: which stage runs
//! when follows from the stamps and the [`Schedule`], so a recording fed again gives the same reports.

mod bumper;
mod camera_mount;
mod captain;
mod config;
mod drawn;
mod eye;
mod helm;
mod histogram;
mod job;
mod last_stage;
mod lazy_image;
mod level_map;
mod look;
mod lookout;
mod map_watch;
mod memory;
mod mission;
mod navigator;
mod progress;
pub mod real_time;
mod report;
mod robot;
mod saving;
mod schedule;
pub mod settings;
mod sight;
mod sight_watch;
mod stage;
mod state;
mod supervisor;
mod supervisor_config;
mod whereabouts;

pub use camera_mount::CameraMount;
pub use config::RobotConfig;
pub use histogram::Histogram;
pub use job::{Answer, Helper, Job};
pub use last_stage::{LastStageConfig, LastStageReport};
pub use lazy_image::LazyImage;
pub use level_map::{LevelMap, level_from_first_camera};
pub use memory::{Memory, MemoryError};
pub use mission::{Mission, MissionState, Task, TaskEnd, TaskRecord};
pub use report::StepReport;
pub use robot::Robot;
pub use schedule::Schedule;
pub use sight::Sight;
pub use stage::{Stage, StageCost, StageTimes};
pub use state::DriveState;
pub use supervisor_config::SupervisorConfig;

//! The outputs of a run: numbers, tables, pages and their folder.

mod camera_picture;
mod goal_outcome;
mod run_folder;
mod run_numbers;
mod sensors_run;
mod state_log;
mod timing_page;
mod zone_files;

pub use crate::setup::mission_text;
pub use camera_picture::{camera_view, landmarks_in_map};
pub use goal_outcome::GoalOutcome;
pub use run_folder::{RunOutput, write_run};
pub use run_numbers::{RunEnd, RunNumbers, TaskCounts, stage_rows, wall_clock};
pub use sensors_run::SensorsRun;
pub use state_log::state_log;
pub use zone_files::write_zones;

//! A run of the robot on any body, shared by all front ends.
//!
//! A [`RunSetup`] names the robot and its mission. [`run_on_body`] feeds the robot from a body ([`trundle_core::RobotBody`]: simulator
//! or hardware; [`RunReplayer`]: a recording), records each input, and ends when the mission is over. [`report::write_run`] writes the
//! folder with map, trajectories, report and summary.
//!
//! ```
//! use trundle_app::{Progress, RunLog, RunRecorder, RunSetup, run_on_body};
//! use trundle_core::Pose2;
//! use trundle_io::OutputFolder;
//! use trundle_runtime::{Mission, RobotConfig, Task};
//! use trundle_sim::{Scene, SimConfig, Simulator};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let place = tempfile::tempdir()?;
//! let mut body = Simulator::new(Scene::by_name("demo", 1)?, SimConfig::default(), 1)?; // or a driver of yours
//! let mission = Mission::new(vec![Task::go(Pose2::new(0.5, 0.0, 0.0))])?;
//! let setup = RunSetup::new("demo", mission, RobotConfig::default()).with_time_limit(1.0);
//! let folder = OutputFolder::create(&place.path().join("run"))?;
//! let recorder = RunRecorder::to_folder(&folder)?;
//! let run = run_on_body(&setup, &mut body, recorder, RunLog::default(), Progress::hidden())?;
//! folder.commit()?;
//! assert_eq!(run.log.contacts(), 0);
//! # Ok(()) }
//! ```

mod best_view;
mod body_log;
mod bounded_file;
pub mod calibrate;
mod checkpoint_file;
mod checkpoint_writer;
pub mod convert;
mod displayed_state;
pub mod dock;
pub mod doctor;
mod encoded_body;
mod error;
pub mod evaluation;
pub mod exit_codes;
mod finished_run;
mod free_space;
pub mod hardware;
mod input_warnings;
pub mod laser_map;
pub mod listening;
pub mod map_edit;
mod map_extent;
mod mission_file;
mod mission_request;
mod number_text;
pub mod operator;
mod overload_watch;
pub mod path_args;
pub mod plan;
mod pose_arg;
mod pose_coverage;
mod pose_sample;
mod program_log;
mod progress;
pub mod real_time;
mod recorder;
mod recording_content;
mod recording_file;
mod recording_switch;
mod replay_source;
mod replayer;
pub mod report;
mod robot_file;
mod run;
mod run_log;
mod run_mark;
mod run_messages;
pub mod sequence;
pub mod sequence_input;
pub mod sequence_run;
mod service_notifier;
mod session;
mod settings;
mod setup;
mod step_progress;
pub mod stop;
pub mod surface;
mod text_table;
mod threads;
pub mod vocabulary_file;
mod written_files;

pub use best_view::BestView;
pub use body_log::BodyLog;
pub use bounded_file::{BoundedFile, BoundedFileError};
pub use checkpoint_file::{first_mission, keep_other_checkpoint, read_checkpoint};
pub use checkpoint_writer::CheckpointWriter;
pub use displayed_state::{DisplayedState, StateDisplay};
pub use encoded_body::{EncodedBody, RunInput};
pub use error::AppError;
pub use finished_run::{FinishedRun, RecordingCost};
pub use free_space::{FreeSpace, MIN_FREE_BYTES};
pub use input_warnings::{log_warnings, read_map, read_trajectory, read_two_maps};
pub use map_extent::MapExtent;
pub use mission_file::read_mission;
pub use mission_request::MissionRequest;
pub use number_text::{NumberRange, NumberText};
pub use pose_arg::PoseArg;
pub use pose_sample::PoseSample;
pub use program_log::{log_lines, start_log};
pub use progress::{Progress, step_line};
pub use recorder::RunRecorder;
pub use recording_content::RecordingContent;
pub use recording_file::FileRecorder;
pub use recording_switch::{RecordingState, RecordingSwitch};
pub use replay_source::ReplaySource;
pub use replayer::RunReplayer;
pub use robot_file::{load_robot, parse_robot, robot_schema, write_robot};
pub use run::{AFTER_ARRIVAL_S, run_on_body};
pub use run_log::{RunLog, StateChange, TrackCounts};
pub use run_mark::{RunMark, RunMarkMessage};
pub use service_notifier::ServiceNotifier;
pub use session::RunSession;
pub use settings::{read_text, read_toml};
pub use setup::{RUN_COMMAND, RunSetup};
pub use step_progress::StepProgress;
pub use text_table::aligned_table;
pub use threads::on_threads;
pub use written_files::{write_files, written_text};

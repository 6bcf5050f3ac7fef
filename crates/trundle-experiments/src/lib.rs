//! The experiments of the papers and benchmarks, in the simulator: each takes a request and returns typed outcomes.
//!
//! An outcome holds a row for each run ([`Trial`] or the experiment's own type). [`ExperimentReport`] evaluates the outcome, makes its
//! table and writes its folder; a front end prints the table.
//!
//! ```
//! use trundle_experiments::{ExperimentReport, corridor};
//!
//! let outcome = corridor::run()?; // the four corridor scenarios of Hong (2024), by two methods
//! assert_eq!(outcome.trials.len(), 8);
//! assert!(outcome.is_success());
//! # Ok::<(), trundle_app::AppError>(())
//! ```

pub mod barn;
pub mod corridor;
mod cpu_clock;
mod csv_rows;
pub mod data_sets;
pub mod docking_station;
mod experiment_context;
mod experiment_display;
mod experiment_report;
pub mod fault_scenarios;
mod index_range;
pub mod known_map;
pub mod laser_drive;
mod laser_run;
pub mod look_alikes;
mod map_scene;
pub mod missions;
pub mod mrpb;
pub mod people;
mod pose_history;
pub mod poses;
pub mod real_time;
mod run_each;
mod shards;
pub mod sim_drive;
pub mod simulated;
mod trial;
pub mod vocabulary;
#[cfg(unix)]
mod wired_trial;

pub use experiment_context::{ExperimentContext, RunSource};
pub use experiment_display::{ExperimentDisplay, RunResult, StagedRun};
pub use experiment_report::{ExperimentReport, RobotExperiment, RunsRequest};
pub use index_range::IndexRange;
pub use shards::{KeptRuns, RunOrigin, Shard, ShardManifest, ShardWriter, shard_arguments};
pub use trial::{ComputerFault, Trial, TrialPlan, run_all, run_one};

//! Common parts of experiments: the request of closed-loop runs, and the report of an outcome.

use crate::ExperimentContext;
use trundle_app::AppError;
use trundle_io::OutputFolder;
use trundle_runtime::RobotConfig;

/// The request of an experiment of closed-loop runs.
#[derive(Debug, Clone)]
pub struct RunsRequest {
    /// Number of seeds of noise and scene, from 1.
    pub seeds: u32,
    /// Text in the name and seed ("lights out, seed 2") of the selected runs; `None` for all runs.
    pub only: Option<String>,
    /// The robot.
    pub robot: RobotConfig,
}

/// An experiment whose robot is its own, unless the request gives another.
pub trait RobotExperiment {
    /// Name of the experiment.
    const NAME: &'static str;
    /// Outcome of the experiment.
    type Outcome: ExperimentReport;

    /// The robot of the runs: the requested one, else the experiment's own.
    fn robot(&self) -> RobotConfig;

    /// Makes the runs.
    ///
    /// # Errors
    /// As the function `run` of the experiment's module.
    fn run(&self, context: &ExperimentContext) -> Result<Self::Outcome, AppError>;
}

/// The report of an experiment's outcome.
pub trait ExperimentReport {
    /// Whether every limit is met.
    fn is_success(&self) -> bool;

    /// The table for the terminal, header first; empty if the verdict is sufficient.
    fn table(&self) -> Vec<Vec<String>>;

    /// The outcome in one or two sentences.
    fn verdict(&self) -> String;

    /// Writes report, tables and pictures into a folder.
    ///
    /// # Errors
    /// When a file cannot be written.
    fn write(&self, folder: &OutputFolder) -> Result<(), AppError>;
}

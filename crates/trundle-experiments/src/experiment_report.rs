//! Common parts of experiments: the request of closed-loop runs, and the report of an outcome.

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

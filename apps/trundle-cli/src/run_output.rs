//! The end of a run: its folder is written, its table printed.

use crate::console;
use crate::outcome::Outcome;
use trundle::app::real_time::RealTimeReport;
use trundle::app::report::write_run;
use trundle::app::{AppError, FinishedRun, RunSetup};
use trundle::io::OutputFolder;

/// Writes the folder of a run and prints its table. Returns whether the goal was reached. A file that could not be written is reported
/// after all other work.
pub fn write(
    setup: &RunSetup,
    mut run: FinishedRun,
    timing: Option<&RealTimeReport>,
    folder: OutputFolder,
    quiet: bool,
) -> Result<Outcome, AppError> {
    let output = write_run(setup, &mut run, timing, folder)?;
    let numbers = &output.numbers;
    if !quiet {
        console::print_table(&numbers.rows(&run));
        if let Some(timing) = timing {
            console::print_table(&timing.rows());
        }
        console::print(&format!("\n{}", numbers.verdict()));
        console::print_see(&output.folder.join("report.html"));
    }
    match output.incomplete {
        Some(error) => Err(error),
        None if numbers.is_success() => Ok(Outcome::Reached),
        // The printed table already contains the verdict.
        None if quiet => Ok(Outcome::unless(Some(numbers.verdict()))),
        None => Ok(Outcome::Missed),
    }
}

//! The folder of an evaluated trajectory.

use super::TrajectoryEvaluation;
use super::page::{page, pictures};
use crate::AppError;
use std::path::PathBuf;
use trundle_io::{OutputFolder, Summary, trajectory_text};

/// Writes the page, its pictures, the aligned trajectory and the summary; the folder. `subtitle` names the evaluated trajectory.
///
/// # Errors
/// When a file cannot be written.
pub fn write_evaluation(
    found: &TrajectoryEvaluation,
    subtitle: &str,
    folder: OutputFolder,
) -> Result<PathBuf, AppError> {
    for (name, bytes) in pictures(found) {
        folder.write(name, &bytes)?;
    }
    folder.write("aligned.txt", trajectory_text(&found.aligned).as_bytes())?;
    folder.write("report.html", page(found, subtitle).to_html().as_bytes())?;
    folder.write("summary.json", found.summary().to_json().as_bytes())?;
    Ok(folder.commit()?)
}

/// Writes a folder with the summary alone.
///
/// # Errors
/// When the file cannot be written.
pub fn write_summary_folder(summary: &Summary, folder: OutputFolder) -> Result<(), AppError> {
    folder.write("summary.json", summary.to_json().as_bytes())?;
    folder.commit()?;
    Ok(())
}

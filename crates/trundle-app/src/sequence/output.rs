//! The folder of a tracked sequence.

use super::comparison::against_truth;
use super::numbers::{sequence_rows, summary};
use super::report::page;
use super::request::SequenceRequest;
use super::run::SequenceRun;
use crate::AppError;
use crate::sequence_input::SequenceInput;
use std::path::PathBuf;
use trundle_io::{OutputFolder, trajectory_text, write_map_as};

/// The written folder, and the table for a front end.
pub struct SequenceOutput {
    /// The folder.
    pub folder: PathBuf,
    /// The table, all but the wall clock's part.
    pub rows: Vec<Vec<String>>,
}

/// Writes map, trajectory, visual map, ground truth, page and summary.
///
/// # Errors
/// When the map cannot be drawn or a file cannot be written.
pub fn write_sequence(
    request: &SequenceRequest,
    input: &SequenceInput,
    run: &SequenceRun,
    folder: OutputFolder,
) -> Result<SequenceOutput, AppError> {
    let trajectory = &run.trajectory.poses;
    let comparison = input.ground_truth().and_then(|truth| against_truth(&input.path, truth, trajectory));
    let comparison = comparison.as_ref();
    let grid = run.map.draw(trajectory, input.robot.mapping.clone())?;
    write_map_as(&folder, "map", &grid, request.map_image)?;
    folder.write("trajectory.txt", trajectory_text(trajectory).as_bytes())?;
    folder.write("visual.map", &run.slam.save())?;
    if let Some(truth) = input.ground_truth() {
        folder.write("groundtruth.txt", trajectory_text(truth).as_bytes())?;
    }
    let rows = sequence_rows(input, run, comparison);
    let page = page(input, run, grid, trajectory, comparison, &rows);
    folder.write("report.html", page.to_html().as_bytes())?;
    folder.write("summary.json", summary(request, input, run, comparison).to_json().as_bytes())?;
    Ok(SequenceOutput { folder: folder.commit()?, rows })
}

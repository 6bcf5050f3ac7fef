//! The folder of a tracked sequence.

use super::comparison::against_truth;
use super::numbers::{sequence_rows, summary};
use super::report::page;
use super::request::SequenceRequest;
use super::run::SequenceRun;
use crate::AppError;
use crate::sequence_input::SequenceInput;
use crate::surface::SurfaceFiles;
use std::path::PathBuf;
use trundle_io::{InputFiles, IoError, OutputFolder, trajectory_text, write_map_as};

/// The written folder, and the table for a front end.
pub struct SequenceOutput {
    /// The folder.
    pub folder: PathBuf,
    /// The table, without the part of the wall clock.
    pub rows: Vec<Vec<String>>,
    /// Why the run missed its goal or a limit, with the likely cause; `None` if it did not.
    pub failure: Option<String>,
    /// Files that could not be written, as an error; `None` if all were.
    pub incomplete: Option<AppError>,
}

/// Writes map, trajectory, visual map, ground truth, surface, page and summary. Files for which the disk has no space are left out.
///
/// # Errors
/// When the map cannot be drawn or a file cannot be written.
pub fn write_sequence(
    request: &SequenceRequest,
    input: &SequenceInput,
    run: &SequenceRun,
    surface: &SurfaceFiles,
    (folder, inputs): (OutputFolder, &InputFiles),
) -> Result<SequenceOutput, AppError> {
    let trajectory = &run.trajectory.poses;
    let comparison = input.ground_truth().and_then(|truth| against_truth(&input.path, truth, trajectory));
    let comparison = comparison.as_ref();
    let grid = run.map.grid(trajectory, input.robot.mapping.clone())?;
    write_map_as(&folder, "map", &grid, request.map_image)?;
    folder.write("trajectory.txt", trajectory_text(trajectory).as_bytes())?;
    folder.write("visual.map", &run.slam.save())?;
    if let Some(truth) = input.ground_truth() {
        folder.write("groundtruth.txt", trajectory_text(truth).as_bytes())?;
    }
    let rows = sequence_rows(input, run, comparison);
    let page = page(input, run, grid, trajectory, comparison, &rows);
    folder.write("report.html", page.to_html().as_bytes())?;
    folder.write("summary.json", summary(request, input, (run, surface), comparison).to_json().as_bytes())?;
    surface.write(&folder, inputs);
    let failure = run.failure().map(|failure| format!("{}: {failure}", input.path.display()));
    let failure = failure.or_else(|| surface.failure.clone());
    let (folder, incomplete) = committed(folder)?;
    Ok(SequenceOutput { folder, rows, failure, incomplete })
}

/// The written folder, and the files that the disk did not take, as an error.
fn committed(folder: OutputFolder) -> Result<(PathBuf, Option<AppError>), AppError> {
    match folder.commit() {
        Ok(place) => Ok((place, None)),
        Err(error @ IoError::Incomplete { .. }) => Ok((error.path().to_owned(), Some(error.into()))),
        Err(error) => Err(error.into()),
    }
}

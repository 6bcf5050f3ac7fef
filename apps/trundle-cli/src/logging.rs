//! Output folders, whose commit writes the log.

use crate::output_args;
use std::path::Path;
use trundle::app::{AppError, log_lines};
use trundle::io::OutputFolder;

/// An output folder whose commit writes `log.txt`: the lines of this program's run.
///
/// # Errors
/// Those of [`OutputFolder::create`].
pub fn output_folder(target: &Path) -> Result<OutputFolder, AppError> {
    let folder = OutputFolder::create_apart_from(output_args::inputs(), target)?;
    Ok(folder.closing_with("log.txt", log_lines))
}

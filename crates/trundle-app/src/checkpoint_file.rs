//! Checkpoint files that a run resumes from.

use crate::AppError;
use std::fmt::Display;
use std::path::Path;
use trundle_io::Expected;
use trundle_runtime::Checkpoint;

/// The checkpoint in this file, and its bytes.
///
/// # Errors
/// When the file cannot be read, is not a checkpoint, or its mission is complete. Names the file.
pub fn read_checkpoint(file: &Path) -> Result<(Checkpoint, Vec<u8>), AppError> {
    let refused = |error: &dyn Display| AppError::Input(format!("{}: {error}", file.display()));
    Expected::Checkpoint.check(file)?;
    let bytes = std::fs::read(file).map_err(|error| refused(&error))?;
    let checkpoint = Checkpoint::from_bytes(&bytes).map_err(|error| refused(&error))?;
    if checkpoint.mission.left.tasks().is_empty() {
        return Err(refused(&"its mission is complete: no task is left to resume"));
    }
    Ok((checkpoint, bytes))
}

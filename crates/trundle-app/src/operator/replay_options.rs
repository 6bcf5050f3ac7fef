//! Options of front ends that a replay does not take.

use crate::AppError;
use std::path::Path;

/// Refuses zones and maps for a replay, which has those of its recording.
///
/// # Errors
/// When a file of zones or a folder of maps is given.
pub fn refuse_for_replay(zones: Option<&Path>, maps: Option<&Path>) -> Result<(), AppError> {
    if let Some(file) = zones {
        let problem = "a replay has the zones of its recording: leave --zones out";
        return Err(AppError::Input(format!("--zones {}: {problem}", file.display())));
    }
    if let Some(folder) = maps {
        let problem = "a replay loads no other map: leave --maps out";
        return Err(AppError::Input(format!("--maps {}: {problem}", folder.display())));
    }
    Ok(())
}

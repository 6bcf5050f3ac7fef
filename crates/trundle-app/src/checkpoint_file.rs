//! Checkpoint files that a run resumes from.

use crate::{AppError, MissionRequest};
use std::fmt::Display;
use std::path::Path;
use trundle_io::{Expected, keep_aside};
use trundle_runtime::{Checkpoint, Mission};

/// The checkpoint in this file, and its bytes.
///
/// # Errors
/// When the file cannot be read, is not a checkpoint, or its mission is complete. Names the file.
pub fn read_checkpoint(file: &Path) -> Result<(Checkpoint, Vec<u8>), AppError> {
    let (checkpoint, bytes) = read_any(file)?;
    if checkpoint.mission.left.tasks().is_empty() {
        return Err(refused(file, &"its mission is complete: no task is left to resume"));
    }
    Ok((checkpoint, bytes))
}

fn read_any(file: &Path) -> Result<(Checkpoint, Vec<u8>), AppError> {
    Expected::Checkpoint.check(file)?;
    let bytes = std::fs::read(file).map_err(|error| refused(file, &error))?;
    let checkpoint = Checkpoint::from_bytes(&bytes).map_err(|error| refused(file, &error))?;
    Ok((checkpoint, bytes))
}

fn refused(file: &Path, error: &dyn Display) -> AppError {
    AppError::Input(format!("{}: {error}", file.display()))
}

/// The mission with which a run begins: the requested one, or the rest of that in the checkpoint `resumed`; and the checkpoint's bytes. A
/// robot that waits for goals (`is_operated`) needs no rest.
///
/// # Errors
/// As [`MissionRequest::mission`] and [`read_checkpoint`].
pub fn first_mission(
    request: &MissionRequest,
    resumed: Option<&Path>,
    is_operated: bool,
) -> Result<(Mission, Option<Vec<u8>>), AppError> {
    let Some(file) = resumed else { return Ok((request.mission()?, None)) };
    let (checkpoint, bytes) = if is_operated { read_any(file)? } else { read_checkpoint(file)? };
    Ok((checkpoint.mission.left, Some(bytes)))
}

/// Renames the file to which a run will write its checkpoints, unless the run resumes from it.
///
/// # Errors
/// When the file cannot be renamed.
pub fn keep_other_checkpoint(written: Option<&Path>, resumed: Option<&Path>) -> Result<(), AppError> {
    let replaced = written.filter(|_| written != resumed);
    Ok(replaced.map_or(Ok(()), keep_aside)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_checkpoint_is_renamed_unless_the_run_resumes_from_it() {
        let folder = tempfile::tempdir().unwrap();
        let (file, kept) = (folder.path().join("a.checkpoint"), folder.path().join("a.checkpoint.1"));
        std::fs::write(&file, "x").unwrap();
        keep_other_checkpoint(Some(&file), Some(&file)).unwrap();
        keep_other_checkpoint(None, Some(&file)).unwrap();
        assert!(file.exists() && !kept.exists());
        keep_other_checkpoint(Some(&file), None).unwrap();
        assert!(!file.exists() && kept.exists());
    }

    #[test]
    fn a_run_without_a_checkpoint_has_the_requested_mission() {
        let request = MissionRequest { explore: true, ..MissionRequest::default() };
        let (mission, bytes) = first_mission(&request, None, false).unwrap();
        assert_eq!((mission.tasks().len(), bytes), (2, None));
        let missing = Path::new("no.checkpoint");
        for is_operated in [true, false] {
            let problem = first_mission(&request, Some(missing), is_operated).unwrap_err().to_string();
            assert!(problem.contains("no.checkpoint"), "{problem}");
        }
    }
}

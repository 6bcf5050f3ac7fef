//! Reading of fault schedules.

use serde::Deserialize;
use std::path::Path;
use trundle_app::{AppError, read_toml};
use trundle_sim::FaultSchedule;

/// A file of faults: a list `[[faults]]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FaultsFile {
    faults: FaultSchedule,
}

/// Reads a fault schedule from a TOML file.
///
/// # Errors
/// Names the file, and the line or the fault.
pub fn read_faults(file: &Path) -> Result<FaultSchedule, AppError> {
    let FaultsFile { faults } = read_toml(file)?;
    faults.validated().map_err(|error| AppError::Input(format!("{}: {error}", file.display())))
}

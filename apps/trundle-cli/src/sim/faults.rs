use crate::{failure::Failure, settings};
use serde::Deserialize;
use std::path::Path;
use trundle::sim::FaultSchedule;

/// A file of faults: a list `[[faults]]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FaultsFile {
    faults: FaultSchedule,
}

/// Reads what breaks, and when.
///
/// # Errors
/// Names the file, and the line or the fault.
pub fn read(file: &Path) -> Result<FaultSchedule, Failure> {
    let FaultsFile { faults } = settings::read(file)?;
    faults.validated().map_err(|error| Failure::Input(format!("{}: {error}", file.display())))
}

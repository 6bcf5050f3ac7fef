//! The choice of a driver.

use super::driver::{ScriptDriver, SimDriver, StillDriver, WaypointDriver};
use super::key_driver::KeyDriver;
use std::path::Path;
use trundle_app::AppError;

/// The driver of a drive: the commands of a `script`, the way-points of a file to `follow`, or none for a person at the keys or the page,
/// who starts once the robot exists. Without a driver the robot rests.
///
/// # Errors
/// When a file cannot be used, or a person at the keys has no terminal.
pub fn chosen_driver(
    (script, follow): (Option<&Path>, Option<&Path>),
    has_keys: bool,
    has_page: bool,
    duration: Option<f64>,
) -> Result<Option<Box<dyn SimDriver>>, AppError> {
    Ok(match (script, follow) {
        (Some(file), _) => Some(Box::new(ScriptDriver::read(file)?)),
        (None, Some(file)) => Some(Box::new(WaypointDriver::read(file)?)),
        (None, None) if has_keys => {
            KeyDriver::require_terminal()?;
            None
        }
        (None, None) if has_page => None,
        (None, None) => Some(Box::new(StillDriver::new(duration))),
    })
}

//! Ctrl-C as a flag that the run reads.

use crate::AppError;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A flag that becomes true at the first Ctrl-C or SIGTERM; the second one ends the program at once.
#[cfg(unix)]
pub fn flag() -> Result<Arc<AtomicBool>, AppError> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    let flag = Arc::<AtomicBool>::default();
    let refused = |error| AppError::Environment(format!("cannot listen for Ctrl-C: {error}"));
    for signal in [SIGINT, SIGTERM] {
        // In this order: the second signal finds the flag set.
        signal_hook::flag::register_conditional_shutdown(signal, 130, Arc::clone(&flag)).map_err(refused)?;
        signal_hook::flag::register(signal, Arc::clone(&flag)).map_err(refused)?;
    }
    Ok(flag)
}

/// Elsewhere the program ends at once.
#[cfg(not(unix))]
pub fn flag() -> Result<Arc<AtomicBool>, AppError> {
    Ok(Arc::default())
}

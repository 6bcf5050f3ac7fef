//! Ctrl-C as a wish.

use crate::failure::Failure;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Becomes true when the user (or the system) asks the program to end; asked again, it ends at once.
#[cfg(unix)]
pub fn flag() -> Result<Arc<AtomicBool>, Failure> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    let flag = Arc::<AtomicBool>::default();
    let refused = |error| Failure::Environment(format!("cannot listen for Ctrl-C: {error}"));
    for signal in [SIGINT, SIGTERM] {
        // In this order: the second signal finds the flag set.
        signal_hook::flag::register_conditional_shutdown(signal, 130, Arc::clone(&flag)).map_err(refused)?;
        signal_hook::flag::register(signal, Arc::clone(&flag)).map_err(refused)?;
    }
    Ok(flag)
}

/// Elsewhere the program ends at once.
#[cfg(not(unix))]
pub fn flag() -> Result<Arc<AtomicBool>, Failure> {
    Ok(Arc::default())
}

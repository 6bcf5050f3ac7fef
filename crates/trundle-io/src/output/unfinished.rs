//! The hidden folders of unfinished results in this process, for an ending from outside of the run.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The unfinished results.
#[derive(Debug, Default)]
struct Unfinished {
    folders: Vec<PathBuf>,
    /// Whether results have been moved to their place.
    is_any_complete: bool,
}

static UNFINISHED: Mutex<Unfinished> = Mutex::new(Unfinished { folders: Vec::new(), is_any_complete: false });

fn unfinished() -> MutexGuard<'static, Unfinished> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Notes a hidden folder.
pub(super) fn add(folder: &Path) {
    unfinished().folders.push(folder.to_owned());
}

/// Removes a hidden folder from the list.
pub(super) fn forget(folder: &Path) {
    unfinished().folders.retain(|known| known != folder);
}

/// Moves results to their place by `complete`; no ending of the process falls between.
pub(super) fn complete<T, E>(complete: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    let mut unfinished = unfinished();
    let result = complete();
    unfinished.is_any_complete |= result.is_ok();
    result
}

/// Removes all unfinished results, for a process that ends: nothing is moved to its place after this. Returns false, and removes
/// nothing, where results are complete: such a process ends by itself.
pub fn abandon_outputs() -> bool {
    let unfinished = unfinished();
    if unfinished.is_any_complete {
        return false;
    }
    for folder in &unfinished.folders {
        let _ = fs::remove_dir_all(folder);
    }
    std::mem::forget(unfinished); // the lock is held until the process ends, so that no result is completed
    true
}

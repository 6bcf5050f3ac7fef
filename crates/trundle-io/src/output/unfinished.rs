//! The hidden folders of unfinished results in this process, for an ending from outside of the run.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::TempDir;

/// The unfinished results.
#[derive(Debug, Default)]
struct Unfinished {
    folders: Vec<PathBuf>,
    /// Whether results have been moved to their place.
    is_any_complete: bool,
}

/// End of the name of a hidden folder that is being removed.
const ABANDONED: &str = ".abandoned";

static UNFINISHED: Mutex<Unfinished> = Mutex::new(Unfinished { folders: Vec::new(), is_any_complete: false });

fn unfinished() -> MutexGuard<'static, Unfinished> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Creates a hidden folder by `create` and records it; the process cannot end between both steps.
pub(super) fn begin<E>(create: impl FnOnce() -> Result<TempDir, E>) -> Result<TempDir, E> {
    let mut unfinished = unfinished();
    let folder = create()?;
    unfinished.folders.push(folder.path().to_owned());
    Ok(folder)
}

/// Removes a hidden folder from the list.
pub(super) fn forget(folder: &Path) {
    unfinished().folders.retain(|known| known != folder);
}

/// Moves results to their place by `complete`; the process cannot end during the move.
pub(super) fn complete<T, E>(complete: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    let mut unfinished = unfinished();
    let result = complete();
    unfinished.is_any_complete |= result.is_ok();
    result
}

/// Removes all unfinished results, for a process that ends: no result is moved to its place afterwards. Returns false without any removal
/// if results are complete: such a process is already ending.
pub fn abandon_outputs() -> bool {
    let unfinished = unfinished();
    if unfinished.is_any_complete {
        return false;
    }
    abandon_all(unfinished);
    true
}

/// Removes all unfinished results, for a process that ends: no result is moved to its place afterwards. Complete results remain.
pub fn abandon_unfinished() {
    abandon_all(unfinished());
}

fn abandon_all(unfinished: MutexGuard<'static, Unfinished>) {
    unfinished.folders.iter().for_each(|folder| abandon(folder));
    std::mem::forget(unfinished); // the lock is held until the process ends, so that no result is begun or completed
}

/// Removes a hidden folder. A thread that is still writing finds no folder at the old name, so no file appears during the removal.
fn abandon(folder: &Path) {
    let mut name = folder.as_os_str().to_owned();
    name.push(ABANDONED);
    let abandoned = PathBuf::from(name);
    let is_renamed = fs::rename(folder, &abandoned).is_ok();
    let _ = fs::remove_dir_all(if is_renamed { &abandoned } else { folder });
}

/// Waits for the end of a process whose results are abandoned; else returns immediately. An error of a writer caused by the removal is no
/// result of the command.
pub fn wait_for_abandonment() {
    drop(unfinished());
}

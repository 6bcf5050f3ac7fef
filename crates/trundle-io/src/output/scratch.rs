//! The hidden folder of results before they appear, and the removal of one left by a killed run.

use super::file_identity::resolved;
use super::unfinished;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The name of every hidden folder begins so.
const PREFIX: &str = ".trundle-";
/// A file that a run locks: without the lock, the run has ended. It contains the results' place.
const OWNER_FILE: &str = "owner";
/// The folder of the results inside the hidden one; it has the user's usual permissions.
const STAGE: &str = "out";
/// The folder in the hidden one that is made to keep the last run.
const KEPT: &str = "kept";
/// The folder inside the hidden one for the previously stored run, until its removal.
const REPLACED: &str = "replaced";
/// The folder inside the hidden one for the marker of an unfinished commit, until the marker is complete.
const UNFINISHED: &str = "unfinished";

/// The file in the hidden folder that keeps space on the disk for the marker of the results.
const RESERVE_FILE: &str = "reserve";
/// Length of that file \[bytes\]: a marker of about 500 files. A marker that is longer may not fit on a full disk. Source: ours.
const RESERVE_BYTES: usize = 1 << 16;

/// A hidden folder for results; a drop removes it.
#[derive(Debug)]
pub(super) struct Scratch {
    dir: TempDir,
    /// Held until the end.
    _owner: File,
}

impl Scratch {
    /// Creates a hidden folder in the folder `beside` for the results of `target`.
    ///
    /// # Errors
    /// When the folder cannot be created, or the disk has no space for the marker of the results.
    pub(super) fn create(beside: &Path, target: &Path) -> io::Result<Self> {
        let dir = unfinished::begin(|| tempfile::Builder::new().prefix(PREFIX).tempdir_in(beside))?;
        let mut owner = File::create(dir.path().join(OWNER_FILE))?;
        // Without locks on the file system, no hidden folder is removed either.
        let _ = owner.try_lock();
        owner.write_all(resolved(target).to_string_lossy().as_bytes())?;
        fs::create_dir(dir.path().join(STAGE))?;
        reserve(&dir.path().join(RESERVE_FILE))?;
        Ok(Self { dir, _owner: owner })
    }

    /// The folder that holds the results.
    pub(super) fn stage(&self) -> PathBuf {
        self.dir.path().join(STAGE)
    }

    /// Frees the space that is kept for the marker.
    pub(super) fn release_reserve(&self) {
        let _ = fs::remove_file(self.dir.path().join(RESERVE_FILE));
    }

    /// Path at which the folder of the last run is prepared.
    pub(super) fn kept(&self) -> PathBuf {
        self.dir.path().join(KEPT)
    }

    /// Path for the previously stored run.
    pub(super) fn replaced(&self) -> PathBuf {
        self.dir.path().join(REPLACED)
    }

    /// Path at which the marker of an unfinished commit is prepared.
    pub(super) fn unfinished(&self) -> PathBuf {
        self.dir.path().join(UNFINISHED)
    }

    /// Removes the folder with its content.
    pub(super) fn remove(&self) {
        let _ = fs::remove_dir_all(self.dir.path());
        unfinished::forget(self.dir.path());
    }
}

/// Keeps space for the marker. Only a full disk is an error: a limit of the length of a file lets the marker through, which is short.
fn reserve(path: &Path) -> io::Result<()> {
    use io::ErrorKind::{QuotaExceeded, StorageFull};
    match fs::write(path, vec![0; RESERVE_BYTES]) {
        Err(error) if [StorageFull, QuotaExceeded].contains(&error.kind()) => Err(error),
        _ => Ok(()),
    }
}

/// Whether this is a hidden folder of a running or ended run.
pub(super) fn is_scratch(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.starts_with(PREFIX) && path.join(OWNER_FILE).is_file()
}

/// Removes the hidden folders in `beside` left by killed runs into `target`; returns their paths. The folder of a running run remains.
pub(super) fn sweep(beside: &Path, target: &Path) -> Vec<PathBuf> {
    let place = resolved(target);
    let entries = fs::read_dir(beside).into_iter().flatten().flatten();
    let left = entries.map(|entry| entry.path()).filter(|path| is_left_behind(path, &place));
    left.filter(|path| fs::remove_dir_all(path).is_ok()).collect()
}

fn is_left_behind(path: &Path, place: &Path) -> bool {
    let owner = path.join(OWNER_FILE);
    let is_for =
        is_scratch(path) && fs::read_to_string(&owner).is_ok_and(|text| text == place.to_string_lossy());
    is_for && File::open(owner).is_ok_and(|file| file.try_lock().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_a_dead_run_into_the_same_place_left_is_swept() {
        let beside = tempfile::tempdir().unwrap();
        let (target, other) = (beside.path().join("run"), beside.path().join("run-2"));
        let alive = Scratch::create(beside.path(), &target).unwrap();
        let dead = |target: &Path| {
            let path = Scratch::create(beside.path(), target).unwrap().dir.path().with_extension("dead");
            fs::create_dir(&path).unwrap();
            fs::write(path.join(OWNER_FILE), resolved(target).to_string_lossy().as_bytes()).unwrap();
            path
        };
        let (ours, theirs) = (dead(&target), dead(&other));
        fs::create_dir(beside.path().join(".trundle-by-hand")).unwrap();
        assert_eq!(sweep(beside.path(), &target), std::slice::from_ref(&ours));
        assert!(!ours.exists() && theirs.exists() && alive.stage().exists());
        assert!(beside.path().join(".trundle-by-hand").exists());
    }
}

//! The hidden folder that results are written to before they appear, and the sweeping of one that a killed run left.

use super::file_identity::resolved;
use super::unfinished;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The name of every hidden folder begins so.
const PREFIX: &str = ".trundle-";
/// A file that a run keeps locked: without the lock, the run has ended. It holds the results' place.
const OWNER_FILE: &str = "owner";
/// The folder in the hidden one that holds the results, so that they get the user's usual permissions.
const STAGE: &str = "out";
/// The folder in the hidden one that is made to keep the last run.
const KEPT: &str = "kept";
/// The folder in the hidden one that takes the run which was kept until then, until it is removed.
const REPLACED: &str = "replaced";
/// The folder in the hidden one that holds the marker of an unfinished commit until it is complete.
const UNFINISHED: &str = "unfinished";

/// A hidden folder for results; it goes with its value.
#[derive(Debug)]
pub(super) struct Scratch {
    dir: TempDir,
    /// Held until the end.
    _owner: File,
}

impl Scratch {
    /// A hidden folder in the folder `beside` for the results of `target`.
    ///
    /// # Errors
    /// When it cannot be created.
    pub(super) fn create(beside: &Path, target: &Path) -> io::Result<Self> {
        let dir = unfinished::begin(|| tempfile::Builder::new().prefix(PREFIX).tempdir_in(beside))?;
        let mut owner = File::create(dir.path().join(OWNER_FILE))?;
        // On a file system without locks nothing is swept either.
        let _ = owner.try_lock();
        owner.write_all(resolved(target).to_string_lossy().as_bytes())?;
        fs::create_dir(dir.path().join(STAGE))?;
        Ok(Self { dir, _owner: owner })
    }

    /// The folder that holds the results.
    pub(super) fn stage(&self) -> PathBuf {
        self.dir.path().join(STAGE)
    }

    /// Where the folder that keeps the last run is made.
    pub(super) fn kept(&self) -> PathBuf {
        self.dir.path().join(KEPT)
    }

    /// Where the run that was kept until then goes.
    pub(super) fn replaced(&self) -> PathBuf {
        self.dir.path().join(REPLACED)
    }

    /// Where the marker of an unfinished commit is made.
    pub(super) fn unfinished(&self) -> PathBuf {
        self.dir.path().join(UNFINISHED)
    }

    /// Removes it with all that is in it.
    pub(super) fn remove(&self) {
        let _ = fs::remove_dir_all(self.dir.path());
        unfinished::forget(self.dir.path());
    }
}

/// Whether this is a hidden folder of a run, alive or not.
pub(super) fn is_scratch(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.starts_with(PREFIX) && path.join(OWNER_FILE).is_file()
}

/// Removes the hidden folders in `beside` that killed runs into `target` left; their paths. One whose run lives stays.
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

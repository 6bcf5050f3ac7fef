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
    /// Creates a hidden folder in the folder `beside` for the results of `target`. Hidden folders there that killed runs into the same
    /// place left are named in the log, and removed.
    ///
    /// # Errors
    /// When the folder cannot be created.
    pub(super) fn create(beside: &Path, target: &Path) -> io::Result<Self> {
        sweep(beside, target);
        let dir = unfinished::begin(|| tempfile::Builder::new().prefix(PREFIX).tempdir_in(beside))?;
        let mut owner = File::create(dir.path().join(OWNER_FILE))?;
        // Without locks on the file system, no hidden folder is removed either.
        let _ = owner.try_lock();
        owner.write_all(resolved(target).to_string_lossy().as_bytes())?;
        fs::create_dir(dir.path().join(STAGE))?;
        Ok(Self { dir, _owner: owner })
    }

    /// This hidden folder, with space on the disk that is kept for the marker of the results. Only a full disk is an error: a limit of the
    /// length of a file lets the marker through, which is short.
    ///
    /// # Errors
    /// When the disk has no space for the marker.
    pub(super) fn with_reserve(self) -> io::Result<Self> {
        use io::ErrorKind::{QuotaExceeded, StorageFull};
        match fs::write(self.dir.path().join(RESERVE_FILE), vec![0; RESERVE_BYTES]) {
            Err(error) if [StorageFull, QuotaExceeded].contains(&error.kind()) => Err(error),
            _ => Ok(self),
        }
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

impl Drop for Scratch {
    fn drop(&mut self) {
        self.remove();
    }
}

/// Whether this is a hidden folder of a running or ended run.
pub(super) fn is_scratch(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.starts_with(PREFIX) && path.join(OWNER_FILE).is_file()
}

/// Removes the hidden folders in `beside` left by killed runs into `target`, and logs them. The folder of a running run remains.
fn sweep(beside: &Path, target: &Path) {
    let place = resolved(target);
    let entries = fs::read_dir(beside).into_iter().flatten().flatten();
    let left = entries.map(|entry| entry.path()).filter(|path| is_left_behind(path, &place));
    left.filter(|path| fs::remove_dir_all(path).is_ok()).for_each(|path| {
        tracing::warn!("{} was left by a run that was killed; it is removed", path.display());
    });
}

fn is_left_behind(path: &Path, place: &Path) -> bool {
    let owner = path.join(OWNER_FILE);
    let is_for =
        is_scratch(path) && fs::read_to_string(&owner).is_ok_and(|text| text == place.to_string_lossy());
    is_for && File::open(owner).is_ok_and(|file| file.try_lock().is_ok())
}

#[cfg(test)]
mod tests {
    use super::super::{InputFiles, OutputFile, OutputFolder, replace_file};
    use super::*;

    /// A hidden folder for `target` as a killed run leaves it.
    fn dead(beside: &Path, target: &Path) -> PathBuf {
        let path = Scratch::create(beside, target).unwrap().dir.path().with_extension("dead");
        fs::create_dir(&path).unwrap();
        fs::write(path.join(OWNER_FILE), resolved(target).to_string_lossy().as_bytes()).unwrap();
        path
    }

    #[test]
    fn results_of_every_kind_sweep_what_a_killed_run_into_their_place_left() {
        let kinds: [fn(&Path); 3] = [
            |path| drop(OutputFolder::create(path).unwrap()),
            |path| {
                OutputFile::create_apart_from(&InputFiles::default(), path).unwrap().write(b"1").unwrap();
            },
            |path| replace_file(path, b"2").unwrap(),
        ];
        let beside = tempfile::tempdir().unwrap();
        for (i, write) in kinds.iter().enumerate() {
            let target = beside.path().join(format!("result-{i}"));
            let left = dead(beside.path(), &target);
            write(&target);
            assert!(!left.exists(), "kind {i}");
        }
        assert_eq!(fs::read_dir(beside.path()).unwrap().count(), 2, "two files, and nothing hidden");
    }

    #[test]
    fn only_what_a_dead_run_into_the_same_place_left_is_swept() {
        let beside = tempfile::tempdir().unwrap();
        let (target, other) = (beside.path().join("run"), beside.path().join("run-2"));
        let alive = Scratch::create(beside.path(), &target).unwrap();
        let (ours, theirs) = (dead(beside.path(), &target), dead(beside.path(), &other));
        fs::create_dir(beside.path().join(".trundle-by-hand")).unwrap();
        sweep(beside.path(), &target);
        assert!(!ours.exists() && theirs.exists() && alive.stage().exists());
        assert!(beside.path().join(".trundle-by-hand").exists());
    }
}

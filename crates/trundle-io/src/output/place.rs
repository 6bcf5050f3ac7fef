//! The place of a folder of results: what may be replaced there, and where the last run is kept.

use super::inputs::InputFiles;
use super::marker::{MARKER_FILE, RunMarker};
use super::scratch::is_scratch;
use super::tree::files_below;
use crate::IoError;
use std::ffi::OsString;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// The place of a folder of results.
#[derive(Debug)]
pub(super) struct OutputPlace {
    /// The folder as it was named.
    pub target: PathBuf,
    /// The same folder, where it is a link what it leads to.
    pub real: PathBuf,
    /// Whether an earlier run is there.
    pub holds_run: bool,
}

impl OutputPlace {
    /// The place `target`, if nothing foreign and no input is lost when its content is replaced.
    ///
    /// # Errors
    /// When it is a file, holds an input or a file that trundle did not write, or the last run cannot be kept.
    pub fn check(target: &Path, inputs: &InputFiles) -> Result<Self, IoError> {
        if target.as_os_str().is_empty() {
            return Err(IoError::malformed(target, "the name of the output folder is empty"));
        }
        let mut place = Self { target: target.to_owned(), real: real_folder(target)?, holds_run: false };
        inputs.require_apart(&place.real)?;
        place.holds_run = place.require_own(&place.real)?;
        if place.holds_run {
            let last = place.last_run();
            inputs.require_apart(&last)?;
            place.require_own(&last)?;
            place.require_unchanged(&last)?;
        }
        Ok(place)
    }

    /// Where the last run is kept: the folder's name with `.1` behind it.
    pub fn last_run(&self) -> PathBuf {
        self.real.with_file_name(with_ending(&self.real, ".1"))
    }

    /// Whether `folder` holds a run of trundle, and nothing else.
    fn require_own(&self, folder: &Path) -> Result<bool, IoError> {
        let unreadable = |error| IoError::system(folder, "read")(error);
        if !folder.exists() {
            return Ok(false);
        }
        if !folder.is_dir() {
            return Err(IoError::malformed(
                folder,
                "the last run is kept here, but a file is in the way; move it",
            ));
        }
        let Some(marker) = RunMarker::read(folder) else {
            let files = files_below(folder).map_err(unreadable)?;
            return files.first().map_or(Ok(false), |first| Err(self.foreign(folder, first, files.len())));
        };
        let foreign = marker.foreign_files(folder).map_err(unreadable)?;
        foreign.first().map_or(Ok(true), |first| Err(self.foreign(folder, first, foreign.len())))
    }

    /// Refuses the kept run, which the next one deletes, where a file of it was edited since trundle wrote it.
    fn require_unchanged(&self, last: &Path) -> Result<(), IoError> {
        let changed = RunMarker::read(last).map(|marker| marker.changed_files(last)).unwrap_or_default();
        let Some(first) = changed.first() else { return Ok(()) };
        let more = if changed.len() > 1 { format!(" and {} more", changed.len() - 1) } else { String::new() };
        let problem = format!(
            "this run would be deleted, but a file of it was changed after the run ({}{more}); move the folder away",
            first.display()
        );
        Err(IoError::malformed(last, problem))
    }

    fn foreign(&self, folder: &Path, first: &Path, count: usize) -> IoError {
        let name = first.strip_prefix(folder).unwrap_or(first).display();
        let more = if count > 1 { format!(" and {} more", count - 1) } else { String::new() };
        let why = if folder == self.real { "to replace" } else { "here, where the last run is kept," };
        let problem = format!(
            "{why} are files that trundle did not write there ({name}{more}); name another folder, or move these files away"
        );
        IoError::malformed(if folder == self.real { &self.target } else { folder }, problem)
    }

    /// Moves everything in `stage`, which has its marker, to the place; what a run left there goes to [`OutputPlace::last_run`].
    ///
    /// # Errors
    /// When the folder has got foreign files meanwhile, or something cannot be moved.
    pub fn fill(&self, stage: &Path) -> Result<(), IoError> {
        if !self.real.exists() {
            return fs::rename(stage, &self.real).map_err(IoError::system(&self.target, "write"));
        }
        if self.require_own(&self.real)? {
            self.require_unchanged(&self.last_run())?;
            self.keep_last_run().map_err(IoError::system(&self.last_run(), "write"))?;
        }
        move_entries(stage, &self.real, |_| true).map_err(IoError::system(&self.target, "write"))
    }

    /// The folder itself stays, so that a shell in it stays in it.
    fn keep_last_run(&self) -> io::Result<()> {
        let last = self.last_run();
        if last.exists() {
            fs::remove_dir_all(&last)?;
        }
        fs::create_dir(&last)?;
        // A copy, so that at no time a folder is without its marker.
        fs::copy(self.real.join(MARKER_FILE), last.join(MARKER_FILE))?;
        move_entries(&self.real, &last, |name| name != MARKER_FILE)
    }
}

/// The first of the names of `path` with `.1`, `.2`, ... behind it at which nothing is.
pub(super) fn free_name(path: &Path) -> PathBuf {
    let is_free = |name: &PathBuf| !name.exists() && !name.is_symlink();
    let names = (1..).map(|n: u64| path.with_file_name(with_ending(path, &format!(".{n}"))));
    names.into_iter().find(is_free).unwrap_or_else(|| path.to_owned())
}

/// The name of `path` with `ending` behind it.
pub(super) fn with_ending(path: &Path, ending: &str) -> OsString {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(ending);
    name
}

fn real_folder(target: &Path) -> Result<PathBuf, IoError> {
    match fs::canonicalize(target) {
        Ok(real) if real.is_dir() => Ok(real),
        Ok(_) => Err(IoError::malformed(target, "this is a file, expected a folder to write the results to")),
        Err(_) if target.is_symlink() => {
            Err(IoError::malformed(target, "this link leads nowhere, expected a folder"))
        }
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            Ok(target.to_owned())
        }
        Err(error) => Err(IoError::system(target, "create")(error)),
    }
}

/// Moves the entries of a folder whose names are `wanted`, the marker first.
fn move_entries(from: &Path, to: &Path, wanted: impl Fn(&std::ffi::OsStr) -> bool) -> io::Result<()> {
    let entries = fs::read_dir(from)?.collect::<io::Result<Vec<_>>>()?;
    let mut names: Vec<_> = entries.into_iter().map(|entry| entry.file_name()).collect();
    names.retain(|name| wanted(name) && !is_scratch(&from.join(name)));
    names.sort_by_key(|name| (name != MARKER_FILE, name.clone()));
    names.iter().try_for_each(|name| fs::rename(from.join(name), to.join(name)))
}

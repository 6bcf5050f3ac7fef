//! The place of a folder of results: the files that may be replaced, and the folder of the last run.

use super::inputs::{InputFiles, is_within};
use super::marker::{MARKER_FILE, RunMarker};
use super::scratch::{Scratch, is_scratch};
use super::tree::files_below;
use crate::IoError;
use std::ffi::OsString;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// The place of a folder of results.
#[derive(Debug)]
pub(super) struct OutputPlace {
    /// The folder as named by the user.
    pub target: PathBuf,
    /// The same folder, with links followed.
    pub real: PathBuf,
    /// Whether the folder contains an earlier run that must be preserved.
    pub holds_run: bool,
}

impl OutputPlace {
    /// The place `target`, if a replacement of its content loses no foreign file and no input.
    ///
    /// # Errors
    /// When the target is a file, contains an input or a file not written by trundle, or the last run cannot be preserved.
    pub fn check(target: &Path, inputs: &InputFiles) -> Result<Self, IoError> {
        if target.as_os_str().is_empty() {
            return Err(IoError::malformed(target, "the name of the output folder is empty"));
        }
        let mut place = Self { target: target.to_owned(), real: real_folder(target)?, holds_run: false };
        inputs.require_apart(&place.real)?;
        place.holds_run = place.holds_whole_run()?;
        if place.holds_run {
            let last = place.last_run();
            inputs.require_apart(&last)?;
            place.require_own(&last)?;
            place.require_unchanged(&last)?;
        }
        Ok(place)
    }

    /// Folder of the last run: the folder's name with the suffix `.1`.
    pub fn last_run(&self) -> PathBuf {
        self.real.with_file_name(with_ending(&self.real, ".1"))
    }

    /// Refuses a file that is written by itself inside the results or the last run.
    pub fn require_outside(&self, file: &Path) -> Result<(), IoError> {
        if is_within(file, &self.real) {
            return Err(self.holds_file(&self.real, file));
        }
        self.require_outside_last_run(file)
    }

    /// Refuses a file inside the last run.
    pub fn require_outside_last_run(&self, file: &Path) -> Result<(), IoError> {
        let last = self.last_run();
        if is_within(file, &last) { Err(self.holds_file(&last, file)) } else { Ok(()) }
    }

    fn holds_file(&self, folder: &Path, file: &Path) -> IoError {
        let whose = if folder == self.real { "of the results" } else { "in which the last run is kept" };
        let problem = format!(
            "this file would lie in {}, the folder {whose}, which is replaced as a whole; name a file outside of it",
            folder.display()
        );
        IoError::malformed(file, problem)
    }

    /// Whether `folder` contains only a run of trundle.
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

    /// Refuses the stored last run, which the next run deletes, if one of its files was edited after trundle wrote it.
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

    /// Moves all files of the stage of `scratch`, which has its marker, to the place; a previous run moves to [`OutputPlace::last_run`]. If
    /// the process is killed at any moment, the last run is complete in one of the two folders.
    ///
    /// # Errors
    /// When foreign files appeared in the folder since the check, or a file cannot be moved.
    pub fn fill(&self, scratch: &Scratch) -> Result<(), IoError> {
        if !self.real.exists() {
            return fs::rename(scratch.stage(), &self.real).map_err(IoError::system(&self.target, "write"));
        }
        if self.holds_whole_run()? {
            self.require_unchanged(&self.last_run())?;
            self.keep_last_run(scratch).map_err(IoError::system(&self.last_run(), "write"))?;
        }
        self.replace_content(scratch).map_err(IoError::system(&self.target, "write"))
    }

    /// Whether the place contains a run that must be preserved. A run with an interrupted commit does not count: the previous run is
    /// preserved.
    fn holds_whole_run(&self) -> Result<bool, IoError> {
        let is_unfinished = || RunMarker::read(&self.real).is_some_and(|marker| marker.is_unfinished);
        Ok(self.require_own(&self.real)? && !is_unfinished())
    }

    /// Copies the last run to its folder; the run also remains at its place.
    pub fn keep_last_run(&self, scratch: &Scratch) -> io::Result<()> {
        let last = self.last_run();
        link_tree(&self.real, &scratch.kept())?;
        if last.exists() {
            fs::rename(&last, scratch.replaced())?;
        }
        fs::rename(scratch.kept(), &last)
    }

    /// Replaces the present content by the results. The folder itself remains, so a shell in this folder is not affected. Until the
    /// replacement is complete, the marker lists both old and new files.
    pub fn replace_content(&self, scratch: &Scratch) -> io::Result<()> {
        let (stage, marker) = (scratch.stage(), self.real.join(MARKER_FILE));
        let [old, new] = [&self.real, &stage].map(|folder| RunMarker::read(folder));
        let is_run_replaced = old.is_some();
        fs::create_dir(scratch.unfinished())?;
        old.unwrap_or_default().giving_place_to(new.unwrap_or_default()).write(&scratch.unfinished())?;
        fs::rename(scratch.unfinished().join(MARKER_FILE), &marker)?;
        if is_run_replaced {
            remove_entries(&self.real)?;
        }
        move_entries(&stage, &self.real)?;
        match fs::rename(stage.join(MARKER_FILE), &marker) {
            // The disk did not take the list of the results, and the next run treats the folder as foreign.
            Err(error) if error.kind() == ErrorKind::NotFound => fs::remove_file(&marker),
            moved => moved,
        }
    }
}

/// The first free name among `path` with the suffixes `.1`, `.2`, ...
pub(super) fn free_name(path: &Path) -> PathBuf {
    let is_free = |name: &PathBuf| !name.exists() && !name.is_symlink();
    let names = (1..).map(|n: u64| path.with_file_name(with_ending(path, &format!(".{n}"))));
    names.into_iter().find(is_free).unwrap_or_else(|| path.to_owned())
}

/// The name of `path` with the suffix `ending`.
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

/// The entries of a folder, but its marker and the hidden folders of runs.
fn entries(folder: &Path) -> io::Result<Vec<OsString>> {
    let entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
    let names = entries.into_iter().map(|entry| entry.file_name());
    Ok(names.filter(|name| name != MARKER_FILE && !is_scratch(&folder.join(name))).collect())
}

fn move_entries(from: &Path, to: &Path) -> io::Result<()> {
    entries(from)?.iter().try_for_each(|name| fs::rename(from.join(name), to.join(name)))
}

fn remove_entries(folder: &Path) -> io::Result<()> {
    entries(folder)?.iter().map(|name| folder.join(name)).try_for_each(|path| {
        if path.is_dir() && !path.is_symlink() { fs::remove_dir_all(path) } else { fs::remove_file(path) }
    })
}

/// A folder `to` with hard links to the files of `from`, or copies if the disk has no hard links.
fn link_tree(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir(to)?;
    for file in files_below(from)? {
        let Ok(name) = file.strip_prefix(from) else { continue };
        let link = to.join(name);
        fs::create_dir_all(link.parent().unwrap_or(to))?;
        fs::hard_link(&file, &link).or_else(|_| fs::copy(&file, &link).map(drop))?;
    }
    fs::set_permissions(to, fs::metadata(from)?.permissions())
}

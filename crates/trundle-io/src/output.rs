//! An output folder that appears complete or not at all, and replaces only an earlier run.

mod file_identity;
mod fingerprint;
mod inputs;
mod marker;
mod outputs;
mod place;
mod recording_folder;
mod replace;
mod scratch;
mod single_file;
#[cfg(test)]
mod tests;
mod tree;
mod unfinished;
mod writable;

pub use inputs::InputFiles;
pub use outputs::CommandOutputs;
pub use recording_folder::RecordingFolder;
pub use replace::{replace_file, require_replaceable};
pub use single_file::{OutputFile, keep_aside};
pub use unfinished::{abandon_outputs, abandon_unfinished, wait_for_abandonment};

use crate::error::is_refusal_of_disk;
use crate::{IoError, Recorder};
use file_identity::is_on_other_disk;
use marker::{MARKER_FILE, RunMarker};
use place::{OutputPlace, free_name, with_ending};
use scratch::Scratch;
use std::fs::{self, File};
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use writable::require_writable;

/// Makes the content of a file.
type Content = fn() -> Vec<u8>;

/// A folder of results that appears complete or not at all.
///
/// Files are written into a hidden temporary folder next to it, and moved to their place by [`OutputFolder::commit`]. A drop without commit
/// removes all written files. The folder of an earlier run is renamed: its name gets the suffix `.1`. A folder with files that trundle did
/// not write is refused, and so is one that holds an input.
#[derive(Debug)]
pub struct OutputFolder {
    place: OutputPlace,
    scratch: Scratch,
    /// Folders above the target that did not exist before, the innermost first.
    made: Vec<PathBuf>,
    /// Files that the disk did not take.
    unwritten: Mutex<Vec<IoError>>,
    /// Name and content of the file that the commit writes.
    last: Option<(&'static str, Content)>,
}

impl OutputFolder {
    /// Prepares results for `target`; no file is visible there before [`OutputFolder::commit`].
    ///
    /// # Errors
    /// Those of [`OutputFolder::check`], and when the folder is not writable.
    pub fn create(target: &Path) -> Result<Self, IoError> {
        Self::create_apart_from(&InputFiles::default(), target)
    }

    /// A folder for results that must not replace any of the files `inputs`.
    ///
    /// # Errors
    /// Those of [`OutputFolder::check`], and when the folder is not writable.
    pub fn create_apart_from(inputs: &InputFiles, target: &Path) -> Result<Self, IoError> {
        let place = OutputPlace::check(target, inputs)?;
        let beside = parent(&place.real);
        let mut made = missing_above(beside);
        let scratch = fs::create_dir_all(beside).map_err(IoError::system(target, "create"));
        let scratch = scratch.and_then(|()| scratch_for(&place));
        let scratch = scratch.inspect_err(|_| remove_empty(&mut made))?;
        Ok(Self { place, scratch, made, unwritten: Mutex::default(), last: None })
    }

    /// Refuses a folder of results that cannot be replaced without a loss.
    ///
    /// # Errors
    /// When `target` is a file, or is or contains one of `inputs` or a file not written by trundle. The same holds for the folder of the
    /// last run.
    pub fn check(inputs: &InputFiles, target: &Path) -> Result<(), IoError> {
        OutputPlace::check(target, inputs).map(drop)
    }

    /// Refuses a folder of results that [`OutputFolder::create`] could not make. Nothing is left there.
    ///
    /// # Errors
    /// When no file can be made beside the folder, nor in it.
    pub fn require_writable(target: &Path) -> Result<(), IoError> {
        let real = file_identity::resolved(target);
        if is_on_other_disk(parent(&real), &real) {
            return require_writable(&real, target);
        }
        let within = |refused| if real.is_dir() { require_writable(&real, target) } else { Err(refused) };
        require_writable(parent(&real), target).or_else(within)
    }

    /// Refuses a file that a command writes by itself, if `target` or the folder of its last run would hold it.
    ///
    /// # Errors
    /// When the file would be replaced together with the results.
    pub(crate) fn require_outside(target: &Path, file: &Path) -> Result<(), IoError> {
        OutputPlace::check(target, &InputFiles::default())?.require_outside(file)
    }

    /// Refuses a file of results in the folder in which the last run is kept.
    ///
    /// # Errors
    /// When the file would be replaced together with the last run.
    pub(crate) fn require_outside_last_run(target: &Path, file: &Path) -> Result<(), IoError> {
        OutputPlace::check(target, &InputFiles::default())?.require_outside_last_run(file)
    }

    /// Name of the file `path` in this folder; `None` if it lies elsewhere.
    #[must_use]
    pub fn name_of(&self, path: &Path) -> Option<String> {
        let (file, place) = (file_identity::resolved(path), file_identity::resolved(&self.place.real));
        let name = file.strip_prefix(place).ok()?;
        name.file_name()?;
        Some(name.to_str()?.to_owned())
    }

    /// This folder with a last file: the commit writes the file `name` with its content at that time.
    pub fn closing_with(mut self, name: &'static str, content: Content) -> Self {
        self.last = Some((name, content));
        self
    }

    /// Final path of the results.
    pub fn target(&self) -> &Path {
        &self.place.target
    }

    /// Path of the file `name` before the commit, for writers that need a path. The caller must create subfolders.
    pub fn staged(&self, name: &str) -> PathBuf {
        self.scratch.stage().join(name)
    }

    /// Writes the file `name`, a path relative to the folder; creates its subfolders. A file that does not fit on the disk is left out and
    /// reported by [`OutputFolder::commit`].
    ///
    /// # Errors
    /// When the file cannot be written for another reason; the error gives its final name.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), IoError> {
        self.write_by(name, |path| fs::write(path, bytes))
    }

    /// Writes the file `name` piece by piece, as [`OutputFolder::write`] does at once.
    ///
    /// # Errors
    /// As [`OutputFolder::write`].
    pub fn write_pieces(
        &self,
        name: &str,
        write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
    ) -> Result<(), IoError> {
        self.write_by(name, |path| {
            let mut file = BufWriter::new(File::create(path)?);
            write(&mut file)?;
            file.flush()
        })
    }

    fn write_by(&self, name: &str, write: impl FnOnce(&Path) -> std::io::Result<()>) -> Result<(), IoError> {
        let path = self.staged(name);
        match self.make_subfolders(name).and_then(|()| write(&path)) {
            Err(error) if is_refusal_of_disk(&error) => {
                let _ = fs::remove_file(&path);
                self.leave_out(IoError::system(&self.target().join(name), "write")(error));
                Ok(())
            }
            other => other.map_err(IoError::system(&self.target().join(name), "write")),
        }
    }

    /// Creates the subfolders of the file `name`, but not the staged folder itself, which is removed when a signal ends the process.
    fn make_subfolders(&self, name: &str) -> std::io::Result<()> {
        let folders: Vec<&Path> = Path::new(name).ancestors().skip(1).collect();
        let below = folders.into_iter().rev().filter(|folder| !folder.as_os_str().is_empty());
        below.map(|folder| self.scratch.stage().join(folder)).try_for_each(|folder| {
            match fs::create_dir(folder) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => Ok(()),
                made => made,
            }
        })
    }

    /// Records a missing or incomplete file, which [`OutputFolder::commit`] reports and the log names.
    pub fn leave_out(&self, problem: IoError) {
        tracing::info!("{problem}");
        self.unwritten.lock().unwrap_or_else(PoisonError::into_inner).push(problem);
    }

    /// Whether the file `name` is written so far.
    pub(crate) fn holds(&self, name: &str) -> bool {
        self.staged(name).is_file()
    }

    /// Whether the disk has refused a file.
    pub fn is_incomplete(&self) -> bool {
        !self.unwritten.lock().unwrap_or_else(PoisonError::into_inner).is_empty()
    }

    /// Starts a recording as the file `name`; finish it before the commit.
    ///
    /// # Errors
    /// When the file cannot be created.
    pub fn recorder(&self, name: &str) -> Result<Recorder<BufWriter<File>>, IoError> {
        self.recordings().recorder(name)
    }

    /// This folder for recordings that another thread starts; finish them before the commit.
    pub fn recordings(&self) -> RecordingFolder {
        RecordingFolder::new(self.scratch.stage(), self.target().to_owned())
    }

    /// Starts a ROS 2 bag as the file `name`; finish it before the commit.
    ///
    /// # Errors
    /// When the file cannot be created.
    pub fn bag(&self, name: &str) -> Result<Recorder<BufWriter<File>>, IoError> {
        let target = self.target().join(name);
        let file = File::create(self.staged(name)).map_err(IoError::system(&target, "create"))?;
        Recorder::bag(BufWriter::with_capacity(1 << 20, file), &target)
    }

    /// Moves all files to their place, and the files of an earlier run to the folder of the last run. Returns the folder.
    ///
    /// # Errors
    /// [`IoError::Incomplete`] when a file could not be written or moved; it holds the folder of the others.
    pub fn commit(mut self) -> Result<PathBuf, IoError> {
        if let Some((name, content)) = self.last {
            self.write(name, &content())?;
        }
        self.made.clear();
        self.scratch.release_reserve();
        self.write_marker();
        let filled = unfinished::complete(|| self.place.fill(&self.scratch));
        filled.map_err(|problem| self.rescued(problem))?;
        let unwritten = std::mem::take(&mut self.unwritten).into_inner();
        IoError::incomplete(Some(self.target()), unwritten.unwrap_or_else(PoisonError::into_inner))?;
        Ok(self.target().to_owned())
    }

    /// Lists the results in the stage. If the list cannot be written, the next run treats the folder as foreign.
    fn write_marker(&self) {
        let stage = self.scratch.stage();
        if let Err(error) = RunMarker::of(&stage).and_then(|marker| marker.write(&stage)) {
            let _ = fs::remove_file(stage.join(MARKER_FILE));
            self.leave_out(IoError::system(&self.target().join(MARKER_FILE), "write")(error));
        }
    }

    /// The results next to their place, if they cannot be moved there.
    fn rescued(&self, problem: IoError) -> IoError {
        let beside = self.place.real.with_file_name(with_ending(&self.place.real, ".new"));
        let rescue = if beside.exists() { free_name(&beside) } else { beside };
        match fs::rename(self.scratch.stage(), &rescue) {
            Ok(()) => IoError::Incomplete { folder: Some(rescue), problems: vec![problem] },
            Err(_) => problem,
        }
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        self.scratch.remove(); // before the folders above it
        remove_empty(&mut self.made);
    }
}

/// The hidden folder next to the place; or inside it if the place is a separate disk or its parent is not writable.
fn scratch_for(place: &OutputPlace) -> Result<Scratch, IoError> {
    let beside = parent(&place.real);
    let failed = IoError::system(&place.target, "create");
    let problem = match is_on_other_disk(beside, &place.real) {
        true => "it is a disk of its own".to_owned(),
        false => match Scratch::create(beside, &place.real).and_then(Scratch::with_reserve) {
            Err(error) if is_protected(&error) && place.real.is_dir() => {
                format!("{}: {error}", beside.display())
            }
            other => return other.map_err(failed),
        },
    };
    if place.holds_run {
        let problem =
            format!("the last run cannot be kept beside this folder ({problem}); name a folder in it");
        return Err(IoError::malformed(&place.target, problem));
    }
    Scratch::create(&place.real, &place.real).and_then(Scratch::with_reserve).map_err(failed)
}

fn is_protected(error: &std::io::Error) -> bool {
    matches!(error.kind(), ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem)
}

fn parent(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The missing folders of the path `dir`, the innermost first.
fn missing_above(dir: &Path) -> Vec<PathBuf> {
    let missing = dir.ancestors().take_while(|dir| !dir.as_os_str().is_empty() && !dir.exists());
    missing.map(Path::to_owned).collect()
}

fn remove_empty(made: &mut Vec<PathBuf>) {
    for dir in made.drain(..) {
        let _ = fs::remove_dir(dir); // refuses folders with something in them, and so it should
    }
}

//! Arguments for results and for inputs: no result replaces an input.

use clap::ArgMatches;
use std::ffi::OsString;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use trundle::app::AppError;
use trundle::io::{InputFiles, OutputFile, OutputFolder};

/// A folder for results on the command line.
#[derive(Debug, Clone)]
pub struct OutputDirArg(PathBuf);

/// A file of results on the command line.
#[derive(Debug, Clone)]
pub struct OutputFileArg(PathBuf);

/// A file that a command reads at its start and may replace by its own newer result.
#[derive(Debug, Clone)]
pub struct ContinuedFileArg(PathBuf);

impl From<OsString> for ContinuedFileArg {
    fn from(text: OsString) -> Self {
        Self(text.into())
    }
}

impl Deref for ContinuedFileArg {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl From<OsString> for OutputDirArg {
    fn from(text: OsString) -> Self {
        Self(text.into())
    }
}

impl From<OsString> for OutputFileArg {
    fn from(text: OsString) -> Self {
        Self(text.into())
    }
}

impl Deref for OutputDirArg {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl Deref for OutputFileArg {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

/// The inputs of the present command.
static INPUTS: OnceLock<InputFiles> = OnceLock::new();

/// Refuses results that would replace an input; returns the folders that the command writes.
///
/// Inputs are all path arguments, and all texts that name a file, except those of the types above.
///
/// # Errors
/// Names the result and the input, or the conflicting files.
pub fn check(matches: &ArgMatches) -> Result<Vec<PathBuf>, AppError> {
    let leaf = std::iter::successors(Some(matches), |matches| Some(matches.subcommand()?.1)).last();
    let leaf = leaf.unwrap_or(matches);
    let texts = values::<String>(leaf).map(PathBuf::from).filter(|path| path.is_file());
    let inputs = InputFiles::new(values::<PathBuf>(leaf).chain(texts));
    let files: Vec<PathBuf> = values::<OutputFileArg>(leaf).map(|file| file.0).collect();
    files.iter().try_for_each(|file| OutputFile::check(&inputs, file))?;
    let continued = values::<ContinuedFileArg>(leaf).map(|file| file.0);
    let inputs = INPUTS.get_or_init(|| inputs).clone().and(files).and(continued);
    let folders: Vec<PathBuf> = values::<OutputDirArg>(leaf).map(|folder| folder.0).collect();
    folders.iter().try_for_each(|folder| OutputFolder::check(&inputs, folder))?;
    Ok(folders)
}

/// All values of this type.
fn values<T: Clone + Send + Sync + 'static>(matches: &ArgMatches) -> impl Iterator<Item = T> {
    let of = |id: &clap::Id| matches.try_get_many::<T>(id.as_str()).ok().flatten();
    matches.ids().filter_map(of).flatten().cloned()
}

/// The inputs of the present command.
pub fn inputs() -> &'static InputFiles {
    INPUTS.get_or_init(InputFiles::default)
}

/// Writes a single file of results.
///
/// # Errors
/// When the file cannot be written, or is an input.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), AppError> {
    Ok(OutputFile::create_apart_from(inputs(), path)?.write(bytes)?)
}

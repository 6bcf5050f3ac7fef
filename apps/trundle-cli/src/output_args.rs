//! Arguments for results and for inputs: no result replaces an input.

use clap::ArgMatches;
use clap::parser::ValueSource;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use trundle::app::AppError;
pub use trundle::app::path_args::{
    ContinuedFileArg, EditedFileArg, OutputDirArg, OutputFileArg, ResultFileArg,
};
use trundle::io::{CommandOutputs, InputFiles};

/// The inputs of the present command.
static INPUTS: OnceLock<InputFiles> = OnceLock::new();

/// Refuses results that would replace an input, or that cannot be written at their place; returns the folders that the command writes.
///
/// Inputs are all path arguments, and all texts that name a file, except those of the types of results.
///
/// # Errors
/// Names the result and the input, the conflicting files, or the folder in which no file can be made.
pub fn check(matches: &ArgMatches) -> Result<Vec<PathBuf>, AppError> {
    let leaf = leaf(matches);
    let texts = values::<String>(leaf).map(PathBuf::from).filter(|path| path.is_file());
    let inputs = InputFiles::new(values::<PathBuf>(leaf).chain(texts));
    let is_given = |id: &clap::Id| leaf.value_source(id.as_str()) == Some(ValueSource::CommandLine);
    let outputs = CommandOutputs {
        folders: values::<OutputDirArg>(leaf).map(|folder| folder.0).collect(),
        named: values_of::<OutputDirArg>(leaf, is_given).map(|folder| folder.0).collect(),
        files: values::<OutputFileArg>(leaf).map(|file| file.0).collect(),
        files_of_folder: values::<ResultFileArg>(leaf).map(|file| file.0).collect(),
        edited: values::<EditedFileArg>(leaf).map(|file| file.0).collect(),
        continued: values::<ContinuedFileArg>(leaf).map(|file| file.0).collect(),
    };
    outputs.check(INPUTS.get_or_init(|| inputs))?;
    Ok(outputs.folders)
}

/// The arguments of the innermost subcommand.
pub fn leaf(matches: &ArgMatches) -> &ArgMatches {
    matches.subcommand().map_or(matches, |(_, below)| leaf(below))
}

/// All values of this type.
fn values<T: Clone + Send + Sync + 'static>(matches: &ArgMatches) -> impl Iterator<Item = T> {
    values_of(matches, |_| true)
}

/// The values of this type of the arguments that `is_wanted`.
fn values_of<T: Clone + Send + Sync + 'static>(
    matches: &ArgMatches,
    is_wanted: impl Fn(&clap::Id) -> bool,
) -> impl Iterator<Item = T> {
    let of = |id: &clap::Id| matches.try_get_many::<T>(id.as_str()).ok().flatten();
    matches.ids().filter(move |id| is_wanted(id)).filter_map(of).flatten().cloned()
}

/// The inputs of the present command.
pub fn inputs() -> &'static InputFiles {
    INPUTS.get_or_init(InputFiles::default)
}

/// Writes files of results.
///
/// # Errors
/// Those of [`trundle::app::write_files`].
pub fn write_files(files: impl IntoIterator<Item = (PathBuf, Vec<u8>)>) -> Result<(), AppError> {
    Ok(trundle::app::write_files(inputs(), files)?)
}

/// Writes a single file of results.
///
/// # Errors
/// When the file cannot be written, or is an input.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), AppError> {
    write_files([(path.to_owned(), bytes.to_vec())])
}

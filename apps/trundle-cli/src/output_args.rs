//! Arguments for results and for inputs: no result replaces an input.

use clap::ArgMatches;
use clap::parser::ValueSource;
use std::ffi::OsString;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use trundle::app::AppError;
use trundle::io::{CommandOutputs, InputFiles, OutputFile};

/// A path on the command line with a meaning of its own.
macro_rules! path_arg {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone)]
        pub struct $name(PathBuf);

        impl From<OsString> for $name {
            fn from(text: OsString) -> Self {
                Self(text.into())
            }
        }

        impl Deref for $name {
            type Target = Path;

            fn deref(&self) -> &Path {
                &self.0
            }
        }
    };
}

path_arg!(
    /// A folder for results.
    OutputDirArg
);
path_arg!(
    /// A file of results, outside of the folder for results.
    OutputFileArg
);
path_arg!(
    /// A file of results that may lie in the folder for results.
    ResultFileArg
);
path_arg!(
    /// A file that a command reads, if it is there, and replaces.
    EditedFileArg
);
path_arg!(
    /// A file that a command reads at its start and may replace by its own newer content.
    ContinuedFileArg
);

/// The inputs of the present command.
static INPUTS: OnceLock<InputFiles> = OnceLock::new();

/// Refuses results that would replace an input, or that cannot be written at their place; returns the folders that the command writes.
///
/// Inputs are all path arguments, and all texts that name a file, except those of the types above.
///
/// # Errors
/// Names the result and the input, the conflicting files, or the folder in which no file can be made.
pub fn check(matches: &ArgMatches) -> Result<Vec<PathBuf>, AppError> {
    let leaf = std::iter::successors(Some(matches), |matches| Some(matches.subcommand()?.1)).last();
    let leaf = leaf.unwrap_or(matches);
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

/// Writes a single file of results.
///
/// # Errors
/// When the file cannot be written, or is an input.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), AppError> {
    OutputFile::create_apart_from(inputs(), path)?.write(bytes)?;
    trundle::app::note_written(path);
    Ok(())
}

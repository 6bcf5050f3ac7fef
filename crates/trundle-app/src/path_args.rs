//! Paths of a command line that are no inputs.

use std::ffi::OsString;
use std::ops::Deref;
use std::path::{Path, PathBuf};

/// A path on the command line with a meaning of its own.
macro_rules! path_arg {
    ($(#[$doc:meta])* $argument:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone)]
        pub struct $argument(pub PathBuf);

        impl From<OsString> for $argument {
            fn from(text: OsString) -> Self {
                Self(text.into())
            }
        }

        impl Deref for $argument {
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

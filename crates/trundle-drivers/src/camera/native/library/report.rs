//! Whether a library is usable, for the user.

use super::{LibrarySpec, LibraryVersion};
use crate::camera::CameraError;
use std::fmt;
use std::path::PathBuf;

/// Whether a library of a camera maker is usable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LibraryReport {
    /// Name of the library.
    pub name: &'static str,
    /// State of the library.
    pub state: LibraryState,
}

/// State of a library.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LibraryState {
    /// The library is loaded and its version is supported.
    Usable {
        /// File of the library.
        file: PathBuf,
        /// Version of the library; `None` without a version function.
        version: Option<LibraryVersion>,
    },
    /// The library cannot be used.
    Unusable {
        /// The missing part, and how to get it.
        problem: String,
    },
}

impl LibraryReport {
    /// The report on the outcome of loading `spec`: the file and the version, or the error.
    pub fn new(spec: &LibrarySpec, loaded: Result<(PathBuf, Option<LibraryVersion>), CameraError>) -> Self {
        let state = match loaded {
            Ok((file, version)) => LibraryState::Usable { file, version },
            Err(error) => LibraryState::Unusable { problem: error.to_string() },
        };
        Self { name: spec.name, state }
    }

    /// Whether cameras of this library can be opened.
    pub fn is_usable(&self) -> bool {
        matches!(self.state, LibraryState::Usable { .. })
    }
}

impl fmt::Display for LibraryReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.state {
            LibraryState::Usable { file, version: Some(version) } => {
                write!(f, "{} {version}: {}", self.name, file.display())
            }
            LibraryState::Usable { file, version: None } => write!(f, "{}: {}", self.name, file.display()),
            LibraryState::Unusable { problem } => write!(f, "{}: {problem}", self.name),
        }
    }
}

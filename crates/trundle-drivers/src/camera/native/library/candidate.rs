//! A file to try for a library.

use std::path::PathBuf;

/// A file to try, and the files to load before it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Candidate {
    /// Files to load first, with their symbols visible to `file`.
    pub preloaded: Vec<PathBuf>,
    /// The library: a path, or a soname for the loader.
    pub file: PathBuf,
}

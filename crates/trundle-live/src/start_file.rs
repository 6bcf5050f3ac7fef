//! Files that are read at the start of the page.

use std::fs::File;
use std::io::{Error, ErrorKind, Result};
use std::path::Path;

/// Opens a regular file; `expected` is its content, for the refusal of another kind. A pipe without a writer would hold the start up for ever.
pub fn open_regular(file: &Path, expected: &str) -> Result<File> {
    if std::fs::metadata(file).is_ok_and(|meta| !meta.is_file()) {
        return Err(Error::new(ErrorKind::InvalidInput, format!("not a regular file, expected {expected}")));
    }
    File::open(file)
}

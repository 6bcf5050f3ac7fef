//! The files below a folder.

use super::scratch::is_scratch;
use std::io;
use std::path::{Path, PathBuf};

/// The files and links below `folder` in the order of their names. Folders behind links, and hidden folders of running runs, are skipped.
///
/// # Errors
/// When a folder cannot be read.
pub(super) fn files_below(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let (mut files, mut open) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder)? {
            let entry = entry?;
            if entry.file_type()?.is_dir() {
                open.extend((!is_scratch(&entry.path())).then(|| entry.path()));
            } else {
                files.push(entry.path());
            }
        }
    }
    files.sort();
    Ok(files)
}

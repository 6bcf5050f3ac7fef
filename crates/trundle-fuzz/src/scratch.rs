//! Files for readers that take paths: a folder for each thread.

use std::path::Path;
use tempfile::TempDir;

thread_local! {
    static FOLDER: TempDir = tempfile::tempdir().expect("a temporary folder can be made");
}

/// Runs `read` on a folder with these files, each with its content.
pub(crate) fn with_files<T>(files: &[(&str, &[u8])], read: impl FnOnce(&Path) -> T) -> T {
    FOLDER.with(|folder| {
        for (name, bytes) in files {
            std::fs::write(folder.path().join(name), bytes).expect("the temporary folder can be written");
        }
        read(folder.path())
    })
}

/// Runs `read` on a file of this name and content.
pub(crate) fn with_file<T>(name: &str, bytes: &[u8], read: impl FnOnce(&Path) -> T) -> T {
    with_files(&[(name, bytes)], |folder| read(&folder.join(name)))
}

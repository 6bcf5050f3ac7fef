//! Atomic replacement of a file.

use crate::IoError;
use std::io::Write;
use std::path::Path;

/// Writes a file that is, at any instant and after any crash, either the old one or the new one, whole: into a hidden file
/// beside it, to the disk, then in its place.
///
/// # Errors
/// When it cannot be written; the old one is untouched then.
pub fn replace_file(path: &Path, bytes: &[u8]) -> Result<(), IoError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let written = std::fs::create_dir_all(folder)
        .and_then(|()| tempfile::Builder::new().prefix(".trundle-").tempfile_in(folder))
        .and_then(|mut file| {
            file.write_all(bytes)?;
            file.as_file().sync_all()?;
            file.persist(path).map_err(|error| error.error)
        });
    written.map(drop).map_err(IoError::system(path, "write"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_new_one_takes_the_place_of_the_old_one_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/memory");
        replace_file(&path, b"old").unwrap();
        replace_file(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
        let error = replace_file(&path.join("below a file"), b"x").unwrap_err().to_string();
        assert!(error.contains("below a file"), "{error}");
    }
}

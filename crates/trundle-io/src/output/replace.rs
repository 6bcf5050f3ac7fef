//! Atomic replacement of a file.

use super::parent;
use super::scratch::Scratch;
use crate::IoError;
use std::fs::{self, File, Permissions};
use std::io::{self, Write};
use std::path::Path;

/// Writes a file that is, at any instant and after any crash, either the complete old or the complete new one. The bytes go into a hidden
/// folder beside the file, to the disk, then in place of the old file. The new one has the rights of the old one. The hidden folder of a
/// killed run is removed by the next replacement of the same file.
///
/// # Errors
/// When the file cannot be written, or the old one may not be: the old file is unchanged then.
pub fn replace_file(path: &Path, bytes: &[u8]) -> Result<(), IoError> {
    let replaced = rights_of(path).and_then(|rights| {
        fs::create_dir_all(parent(path))?;
        let scratch = Scratch::create(parent(path), path)?;
        let new = scratch.stage().join("file");
        write_through(&new, bytes, rights)?;
        fs::rename(new, path)
    });
    replaced.map_err(IoError::system(path, "write"))
}

/// Checks that [`replace_file`] can write a file at `path`; creates the folder if missing.
///
/// # Errors
/// When the file cannot be written.
pub fn require_replaceable(path: &Path) -> Result<(), IoError> {
    let made = rights_of(path).and_then(|_| {
        fs::create_dir_all(parent(path))?;
        tempfile::tempfile_in(parent(path))
    });
    made.map(drop).map_err(IoError::system(path, "create"))
}

/// Writes the file `path`, down to the disk. Without `rights` it has those of a new file.
fn write_through(path: &Path, bytes: &[u8], rights: Option<Permissions>) -> io::Result<()> {
    let mut file = File::create_new(path)?;
    rights.map_or(Ok(()), |rights| file.set_permissions(rights))?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Rights of the file at `path`, which its replacement gets; `None` without a file.
fn rights_of(path: &Path) -> io::Result<Option<Permissions>> {
    match fs::metadata(path) {
        Ok(old) if old.permissions().readonly() => Err(io::ErrorKind::PermissionDenied.into()),
        Ok(old) => Ok(Some(old.permissions())),
        Err(_) => Ok(None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn the_new_one_has_the_rights_of_the_old_one_and_a_read_only_one_stays() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("robot.toml");
        let mode = || fs::metadata(&path).unwrap().permissions().mode() & 0o777;
        fs::write(&path, b"old").unwrap();
        fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
        replace_file(&path, b"new").unwrap();
        assert_eq!(mode(), 0o640);
        fs::set_permissions(&path, Permissions::from_mode(0o444)).unwrap();
        let error = replace_file(&path, b"newer").unwrap_err().to_string();
        assert!(error.contains("robot.toml") && error.contains("no permission"), "{error}");
        assert_eq!((fs::read(&path).unwrap().as_slice(), mode()), (&b"new"[..], 0o444));
    }

    #[test]
    fn the_new_one_takes_the_place_of_the_old_one_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/memory");
        replace_file(&path, b"old").unwrap();
        replace_file(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
        let error = replace_file(&path.join("below a file"), b"x").unwrap_err().to_string();
        assert!(error.contains("below a file"), "{error}");
    }
}

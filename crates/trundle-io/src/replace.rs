//! Atomic replacement of a file.

use crate::IoError;
use std::fs::Permissions;
use std::io::{self, Write};
use std::path::Path;
use tempfile::NamedTempFile;

/// Writes a file that is, at any instant and after any crash, either the complete old or the complete new one. The bytes go into a hidden
/// file in the same folder, to the disk, then in place of the old file. The new one has the rights of the old one.
///
/// # Errors
/// When the file cannot be written, or the old one may not be: the old file is unchanged then.
pub fn replace_file(path: &Path, bytes: &[u8]) -> Result<(), IoError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let rights = rights_of(path).map_err(IoError::system(path, "write"))?;
    let written =
        std::fs::create_dir_all(folder).and_then(|()| hidden_file(folder, rights)).and_then(|mut file| {
            file.write_all(bytes)?;
            file.as_file().sync_all()?;
            file.persist(path).map_err(|error| error.error)
        });
    written.map(drop).map_err(IoError::system(path, "write"))
}

/// Checks that [`replace_file`] can write a file at `path`; creates the folder if missing.
///
/// # Errors
/// When the file cannot be written.
pub fn require_replaceable(path: &Path) -> Result<(), IoError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let made = std::fs::create_dir_all(folder).and_then(|()| hidden_file(folder, rights_of(path)?));
    made.map(drop).map_err(IoError::system(path, "write"))
}

/// A hidden file with the permissions of the replaced one, or else of a new file, reduced by the user's mask.
fn hidden_file(folder: &Path, rights: Rights) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".trundle-");
    match rights {
        Rights::New(rights) => builder.permissions(rights).tempfile_in(folder),
        Rights::Old(rights) => {
            let file = builder.tempfile_in(folder)?;
            file.as_file().set_permissions(rights)?;
            Ok(file)
        }
    }
}

/// Rights of the file that replaces another one.
enum Rights {
    /// Permissions of the old file.
    Old(Permissions),
    /// Permissions of a new file, before the user's mask.
    New(Permissions),
}

/// Rights of a new file, before the user's mask. Source: POSIX.
#[cfg(unix)]
const NEW_FILE_MODE: u32 = 0o666;

/// Rights for the file that replaces `path`.
#[cfg(unix)]
fn rights_of(path: &Path) -> io::Result<Rights> {
    use std::os::unix::fs::PermissionsExt;
    match std::fs::metadata(path) {
        Ok(old) if old.permissions().readonly() => Err(io::ErrorKind::PermissionDenied.into()),
        Ok(old) => Ok(Rights::Old(old.permissions())),
        Err(_) => Ok(Rights::New(Permissions::from_mode(NEW_FILE_MODE))),
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
        let mode = || std::fs::metadata(&path).unwrap().permissions().mode() & 0o777;
        std::fs::write(&path, b"old").unwrap();
        std::fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
        replace_file(&path, b"new").unwrap();
        assert_eq!(mode(), 0o640);
        std::fs::set_permissions(&path, Permissions::from_mode(0o444)).unwrap();
        let error = replace_file(&path, b"newer").unwrap_err().to_string();
        assert!(error.contains("robot.toml") && error.contains("no permission"), "{error}");
        assert_eq!((std::fs::read(&path).unwrap().as_slice(), mode()), (&b"new"[..], 0o444));
    }

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

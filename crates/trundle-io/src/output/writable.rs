//! Whether the system lets a file be made at a place, before the work whose result it will hold.

use crate::IoError;
use crate::error::reason;
use std::path::{Path, PathBuf};

/// Refuses results at `target` if no file can be made in `folder`, or in its nearest parent that exists. Nothing is left there.
///
/// # Errors
/// Names the folder and the system's reason.
pub(super) fn require_writable(folder: &Path, target: &Path) -> Result<(), IoError> {
    let nearest = nearest_existing(folder);
    let named = nearest.display();
    if nearest.is_file() {
        let problem = format!(
            "cannot be written: a file is in the way, {named}; name another place, or move this file"
        );
        return Err(IoError::malformed(target, problem));
    }
    tempfile::tempfile_in(&nearest).map(drop).map_err(|error| {
        let problem = format!(
            "cannot be written: no file can be made in {named} ({}); name another place, or change the rights of this folder",
            reason(&error)
        );
        IoError::malformed(target, problem)
    })
}

/// The folder, or the nearest of its parents that exists, as an absolute path; links without an end exist.
fn nearest_existing(folder: &Path) -> PathBuf {
    let absolute = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let found = absolute.ancestors().find(|part| part.symlink_metadata().is_ok());
    found.map_or_else(|| absolute.clone(), Path::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_folder_to_come_is_tried_in_its_parent_and_nothing_is_left() {
        let place = tempfile::tempdir().unwrap();
        require_writable(&place.path().join("a/b"), Path::new("a/b/x.glb")).unwrap();
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0);
        let file = place.path().join("file");
        fs::write(&file, "mine").unwrap();
        for folder in [file.clone(), file.join("deep")] {
            let error = require_writable(&folder, Path::new("x.glb")).unwrap_err().to_string();
            assert!(error.contains("x.glb: cannot be written: a file is in the way"), "{error}");
        }
        assert_eq!(fs::read(&file).unwrap(), b"mine");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_folder_of_the_system_is_refused_for_every_user() {
        let error = require_writable(Path::new("/proc/no/such"), Path::new("x.glb")).unwrap_err();
        assert!(error.to_string().contains("no file can be made in /proc"), "{error}");
    }
}

//! Reading of a file that may be something else: a pipe, a device, or without end.

use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::path::Path;
use thiserror::Error;

/// A file to be read: regular, not too large, and within a folder if one is given.
#[derive(Debug, Clone, Copy)]
pub struct BoundedFile<'a> {
    /// Path of the file.
    pub path: &'a Path,
    /// The folder that must contain the file after all links are followed.
    pub folder: Option<&'a Path>,
    /// Maximum size of the file \[bytes\].
    pub max_bytes: u64,
}

/// Reason why a file is not read, to follow the file's name.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BoundedFileError {
    /// The system refuses the file.
    #[error("cannot be read ({0})")]
    System(#[from] io::Error),
    /// The file is missing or outside its folder. The two are not distinguished, which does not reveal files elsewhere.
    #[error("is missing or outside its folder")]
    Outside,
    /// The path is a pipe, a folder or a device.
    #[error("is no regular file")]
    NotRegular,
    /// The file is too large.
    #[error("has {bytes} bytes, expected at most {max_bytes}")]
    TooLarge {
        /// Size of the file; if it has none, as in `/proc`, the bytes read.
        bytes: u64,
        /// Maximum size.
        max_bytes: u64,
    },
}

impl BoundedFileError {
    /// Whether there is no such file.
    #[must_use]
    pub fn is_missing(&self) -> bool {
        matches!(self, Self::System(error) if error.kind() == io::ErrorKind::NotFound)
    }
}

impl BoundedFile<'_> {
    /// Reads the bytes of the file. A pipe without a writer is refused and not waited for.
    ///
    /// # Errors
    /// As [`BoundedFileError`].
    pub fn read(&self) -> Result<Vec<u8>, BoundedFileError> {
        let file = self.open()?;
        let bytes = file.metadata()?.len();
        self.require_size(bytes)?;
        let mut content = Vec::with_capacity(bytes as usize);
        // The file may grow during reading.
        file.take(self.max_bytes.saturating_add(1)).read_to_end(&mut content)?;
        self.require_size(content.len() as u64)?;
        Ok(content)
    }

    fn open(&self) -> Result<File, BoundedFileError> {
        let path = match self.folder {
            None => self.path.canonicalize()?,
            Some(folder) => within(folder, self.path).ok_or(BoundedFileError::Outside)?,
        };
        // Opening a device may act on it.
        if !path.metadata()?.is_file() {
            return Err(BoundedFileError::NotRegular);
        }
        let file = open_without_waiting(&path)?;
        // Another file may have taken the name since.
        if !file.metadata()?.is_file() {
            return Err(BoundedFileError::NotRegular);
        }
        Ok(file)
    }

    fn require_size(&self, bytes: u64) -> Result<(), BoundedFileError> {
        let max_bytes = self.max_bytes;
        if bytes > max_bytes { Err(BoundedFileError::TooLarge { bytes, max_bytes }) } else { Ok(()) }
    }
}

/// The path without links, if it is within a folder.
fn within(folder: &Path, path: &Path) -> Option<std::path::PathBuf> {
    let folder = folder.canonicalize().ok()?;
    path.canonicalize().ok().filter(|path| path.starts_with(folder))
}

fn open_without_waiting(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt;
        // The path contains no link: a link found now was created since the check.
        options.custom_flags((OFlags::NONBLOCK | OFlags::NOFOLLOW).bits() as i32);
    }
    options.open(path)
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(path: &Path, max_bytes: u64) -> BoundedFileError {
        BoundedFile { path, folder: None, max_bytes }.read().unwrap_err()
    }

    #[test]
    fn a_regular_file_and_a_link_to_it_are_read_up_to_the_limit() {
        let place = tempfile::tempdir().unwrap();
        let (file, link) = (place.path().join("file"), place.path().join("link"));
        std::fs::write(&file, "1234").unwrap();
        std::os::unix::fs::symlink("file", &link).unwrap();
        for path in [&file, &link] {
            assert_eq!(BoundedFile { path, folder: None, max_bytes: 4 }.read().unwrap(), b"1234");
        }
        assert_eq!(refusal(&link, 3).to_string(), "has 4 bytes, expected at most 3");
        assert!(refusal(&place.path().join("absent"), 3).is_missing());
    }

    #[test]
    fn what_is_no_regular_file_is_refused_without_waiting() {
        let place = tempfile::tempdir().unwrap();
        let pipe = place.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        for path in [&pipe, place.path(), Path::new("/dev/zero")] {
            assert!(matches!(refusal(path, 1), BoundedFileError::NotRegular), "{}", path.display());
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_that_reports_no_size_is_bounded_too() {
        let refused = refusal(Path::new("/proc/self/maps"), 16);
        assert!(matches!(refused, BoundedFileError::TooLarge { bytes: 17, max_bytes: 16 }), "{refused}");
    }
}

//! Reading of a file that others may have put into a folder.

use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::path::Path;

/// A file of a folder: regular, within the folder, and not too large.
pub struct BoundedFile<'a> {
    /// Path of the file.
    pub path: &'a Path,
    /// The folder that must contain the file after all links are followed.
    pub folder: &'a Path,
    /// Maximum size of the file.
    pub max_bytes: u64,
}

impl BoundedFile<'_> {
    /// Reads the bytes of the file.
    ///
    /// # Errors
    /// The reason why the file is not read, to follow the file's name. A file outside the folder and a missing file give the same error,
    /// which does not reveal files elsewhere.
    pub fn read(&self) -> Result<Vec<u8>, String> {
        let outside = |_| "is missing or outside the folder of maps".to_owned();
        let failed = |error: io::Error| format!("cannot be read ({error})");
        let folder = self.folder.canonicalize().map_err(outside)?;
        let path = self.path.canonicalize().map_err(outside)?;
        if !path.starts_with(folder) {
            return Err(outside(io::ErrorKind::NotFound.into()));
        }
        let file = open(&path).map_err(failed)?;
        let about = file.metadata().map_err(failed)?;
        if !about.is_file() {
            return Err("is no regular file".to_owned());
        }
        if about.len() > self.max_bytes {
            return Err(format!("has {} bytes, expected at most {}", about.len(), self.max_bytes));
        }
        let mut bytes = Vec::with_capacity(about.len() as usize);
        // The file may grow during reading.
        file.take(self.max_bytes).read_to_end(&mut bytes).map_err(failed)?;
        Ok(bytes)
    }
}

/// Opens a file without waiting: a pipe without a writer opens too, and is refused by its kind.
fn open(path: &Path) -> io::Result<File> {
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

//! Reading of a file that others may have put into a folder.

use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::path::Path;

/// A file of a folder: regular, within the folder, and not too large.
pub struct BoundedFile<'a> {
    /// Where it is.
    pub path: &'a Path,
    /// The folder that it must lie in once all links are followed.
    pub folder: &'a Path,
    /// Its largest size.
    pub max_bytes: u64,
}

impl BoundedFile<'_> {
    /// Its bytes.
    ///
    /// # Errors
    /// Why it is not read, to follow the file's name. A file outside the folder and one that does not exist give the same answer:
    /// nobody learns which files there are elsewhere.
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
        // It may grow while it is read.
        file.take(self.max_bytes).read_to_end(&mut bytes).map_err(failed)?;
        Ok(bytes)
    }
}

/// Opens a file without a wait: a pipe that nobody writes into opens too, and is refused by its kind.
fn open(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt;
        // The path has no links left: one that is there now has been put there since.
        options.custom_flags((OFlags::NONBLOCK | OFlags::NOFOLLOW).bits() as i32);
    }
    options.open(path)
}

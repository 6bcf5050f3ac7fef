//! The first bytes of a file.

use crate::IoError;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Number of bytes at the start of a file that are inspected \[B\]. A kind whose marks come later is not recognised. Source: ours.
pub(super) const HEAD_BYTES: u64 = 64 << 10;

/// Refuses a pipe or a device: its first bytes would be lost for the reader, and it may never end. A missing file or a folder is left to
/// the reader.
fn require_regular(path: &Path) -> Result<(), IoError> {
    let is_other = std::fs::metadata(path).is_ok_and(|file| !file.is_file() && !file.is_dir());
    let problem = "a pipe or a device, expected a regular file";
    if is_other { Err(IoError::malformed(path, problem)) } else { Ok(()) }
}

/// The first 64 KiB of a file, or all of a shorter one.
pub(super) fn head(path: &Path) -> Result<Vec<u8>, IoError> {
    require_regular(path)?;
    let mut head = Vec::new();
    let file = File::open(path).map_err(IoError::system(path, "read"))?;
    file.take(HEAD_BYTES).read_to_end(&mut head).map_err(IoError::system(path, "read"))?;
    Ok(head)
}

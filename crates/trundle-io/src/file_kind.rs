//! Kinds of files and folders, recognised by their content.

mod binary;
mod expected;
mod folder;
mod head;
mod kind;
mod packed;
mod text;
mod words;

pub use expected::Expected;
pub(crate) use folder::is_bag_file;
pub use kind::FileKind;

use crate::IoError;
use head::head;
use std::fmt;
use std::path::Path;

impl FileKind {
    /// The kind of a file by its first 64 KiB, or of a folder by its members.
    ///
    /// # Errors
    /// When the path does not exist or cannot be read.
    pub fn of(path: &Path) -> Result<Self, IoError> {
        let meta = std::fs::metadata(path).map_err(IoError::system(path, "read"))?;
        if meta.is_dir() {
            return folder::kind_of(path);
        }
        if !meta.is_file() {
            return Ok(Self::Stream);
        }
        Ok(Self::of_bytes(&head(path)?, meta.len()))
    }

    /// Whether this is a ROS bag, or a file that may be one: MCAP of any profile, or packed with zstd.
    #[must_use]
    pub fn is_bag(self) -> bool {
        matches!(
            self,
            Self::Ros1Bag
                | Self::Ros2Mcap
                | Self::Ros2Sqlite
                | Self::Ros2BagFolder
                | Self::OtherMcap
                | Self::Zstd
        )
    }

    /// The kind of a file that begins with `head` and has `len` bytes in all.
    #[must_use]
    pub fn of_bytes(head: &[u8], len: u64) -> Self {
        if head.is_empty() {
            return Self::Empty;
        }
        binary::kind_of(head, len).unwrap_or_else(|| text::kind_of(head))
    }
}

impl fmt::Display for FileKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(words::name(*self))
    }
}

#[cfg(test)]
mod tests;

//! Errors of importing a world from a file.

use trundle_core::Invalid;

/// Reason why a file gives no world.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{file}: {fault}")]
pub struct ImportError {
    /// The file, as the user named it.
    pub file: String,
    /// The fault of the file.
    pub fault: ImportFault,
}

/// A fault of a file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImportFault {
    /// The file system refuses.
    #[error("cannot be read: {reason}")]
    Unreadable {
        /// The message of the reader.
        reason: String,
    },
    /// The file is shorter than its header declares.
    #[error("{item} has {found} bytes, expected {expected}: the file is cut short")]
    Truncated {
        /// The part of the file.
        item: String,
        /// Number of bytes in the file.
        found: u64,
        /// Number of bytes expected.
        expected: u64,
    },
    /// The file is not glTF 2.0.
    #[error("is not glTF 2.0: {reason}")]
    NotGltf {
        /// Place and reason.
        reason: String,
    },
    /// The file requires an unsupported extension.
    #[error("needs the glTF extension {name}, which trundle does not read; export it without")]
    Extension {
        /// Name of the extension.
        name: String,
    },
    /// A buffer outside the file is missing.
    #[error("{item}: {reason}")]
    Part {
        /// The item, with its file name if it has one.
        item: String,
        /// Reason.
        reason: String,
    },
    /// The scene has no surface.
    #[error("has no triangles in its scene")]
    NoTriangles,
    /// A number: not finite, out of range, too large.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}

impl ImportFault {
    pub(super) fn part(item: impl Into<String>, reason: impl ToString) -> Self {
        Self::Part { item: item.into(), reason: reason.to_string() }
    }

    pub(super) fn of(self, file: &str) -> ImportError {
        ImportError { file: file.into(), fault: self }
    }
}

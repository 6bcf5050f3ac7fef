//! Errors of importing a world from a file.

use trundle_core::Invalid;

/// Why a file makes no world.
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
        /// Which part.
        item: String,
        /// Bytes there are.
        found: u64,
        /// Bytes there should be.
        expected: u64,
    },
    /// Not glTF 2.0.
    #[error("is not glTF 2.0: {reason}")]
    NotGltf {
        /// Where and why.
        reason: String,
    },
    /// It cannot be understood without an extension that is not supported.
    #[error("needs the glTF extension {name}, which trundle does not read; export it without")]
    Extension {
        /// Its name.
        name: String,
    },
    /// A buffer outside the file is missing.
    #[error("{item}: {reason}")]
    Part {
        /// Which one, with its file name if it has one.
        item: String,
        /// Why.
        reason: String,
    },
    /// There is no surface in its scene.
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

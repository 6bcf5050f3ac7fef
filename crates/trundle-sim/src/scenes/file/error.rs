//! Errors of a scene file.

use std::path::Path;
use trundle_core::Invalid;

/// Reason why a referred file could not be loaded.
pub type LoadError = Box<dyn std::error::Error + Send + Sync>;

/// Problems of a scene file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// An item, named as in the file (`props[3].size`).
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// A file of the base.
    #[error("{field} '{path}': {source}")]
    Load {
        /// The item that refers to the file.
        field: &'static str,
        /// The file, as given in the item.
        path: String,
        /// The reader's error.
        source: LoadError,
    },
}

impl SceneError {
    pub(super) fn missing(field: &str, expected: &str) -> Self {
        Invalid::new(field, "missing", "", expected).into()
    }

    pub(super) fn load(field: &'static str, path: &Path, source: LoadError) -> Self {
        Self::Load { field, path: path.display().to_string(), source }
    }
}

/// `error` about a value of `item`.
pub(super) fn within(item: &str, error: Invalid) -> SceneError {
    Invalid { field: format!("{item}: {}", error.field), ..error }.into()
}

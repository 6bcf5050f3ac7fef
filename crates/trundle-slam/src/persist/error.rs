//! Reason why a saved map cannot be loaded.

use trundle_core::Invalid;

/// Reason why a saved map was not loaded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MapFileError {
    /// The file is not a visual map of this program.
    #[error("this is not a visual map of trundle (visual.map)")]
    Foreign,
    /// The format version is not supported.
    #[error("map of version {found}, expected {expected}")]
    Version {
        /// Version in the file.
        found: u8,
        /// Version of this program.
        expected: u8,
    },
    /// The checksum does not match: the file is damaged.
    #[error("the map is damaged: its checksum is wrong")]
    Checksum,
    /// The bytes end too early.
    #[error("the map is cut off in its {within}")]
    Cut {
        /// The part that was being read.
        within: &'static str,
    },
    /// The map was made with another camera or other feature settings.
    #[error("the map was made with {name} {saved}, not {given}")]
    Mismatch {
        /// Name of the setting.
        name: &'static str,
        /// Value in the file.
        saved: String,
        /// Value in the configuration.
        given: String,
    },
    /// The checksum is right, but a number is impossible.
    #[error("the map contradicts itself: {0}")]
    Content(#[source] Invalid),
    /// The configuration given is out of range.
    #[error(transparent)]
    Config(#[from] Invalid),
}

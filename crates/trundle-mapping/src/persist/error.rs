//! Errors of loading a saved filter.

use trundle_core::Invalid;

/// Reason why a saved filter was not loaded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilterFileError {
    /// The file is not a filter of this program.
    #[error("this is not a filter map of trundle (filter.map)")]
    Foreign,
    /// The format version is not supported.
    #[error("map of version {found}, expected {expected}")]
    Version {
        /// Version of the bytes.
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
    /// The map was made with another cell size or sensor model.
    #[error("the map was made with {name} {saved}, not {given}")]
    Mismatch {
        /// Name of the setting.
        name: &'static str,
        /// Value in the file.
        saved: f64,
        /// Value in the configuration.
        given: f64,
    },
    /// The checksum is right, but a number is impossible.
    #[error("the map contradicts itself: {what}")]
    Content {
        /// Name of the number.
        what: &'static str,
    },
    /// The configuration given is out of range.
    #[error(transparent)]
    Config(#[from] Invalid),
}

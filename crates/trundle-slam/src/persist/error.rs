//! Why a saved map cannot be loaded.

use trundle_core::Invalid;

/// Why a saved map was not loaded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapFileError {
    /// The file is not a visual map of this program.
    #[error("this is not a visual map of trundle (visual.map)")]
    Foreign,
    /// Made by a version that this one does not read.
    #[error("map of version {found}, expected {expected}")]
    Version {
        /// Of the bytes.
        found: u8,
        /// Of this program.
        expected: u8,
    },
    /// A bit was lost or changed.
    #[error("the map is damaged: its checksum is wrong")]
    Checksum,
    /// The bytes end too early.
    #[error("the map is cut off in its {within}")]
    Cut {
        /// The part that was being read.
        within: &'static str,
    },
    /// Features of another camera, or of other settings, are not those of this map.
    #[error("the map was made with {name} {saved}, not {given}")]
    Mismatch {
        /// Which setting.
        name: &'static str,
        /// Value in the file.
        saved: String,
        /// Value in the configuration.
        given: String,
    },
    /// The checksum is right, and yet a number cannot be.
    #[error("the map contradicts itself: {0}")]
    Content(#[source] Invalid),
    /// The configuration given is out of range.
    #[error(transparent)]
    Config(#[from] Invalid),
}

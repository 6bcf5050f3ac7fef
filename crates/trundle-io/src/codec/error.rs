//! Reason why an image cannot be decoded or encoded.

use thiserror::Error;
use trundle_core::Invalid;

/// Reason why an image cannot be decoded or encoded.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CodecError {
    /// The bytes are not an image, or not a whole one.
    #[error("{kind} image cannot be decoded: {problem}")]
    Decode {
        /// `colour` or `depth`.
        kind: &'static str,
        /// The decoder's message.
        problem: String,
    },
    /// The image cannot be encoded.
    #[error("{kind} image cannot be encoded: {problem}")]
    Encode {
        /// `colour` or `depth`.
        kind: &'static str,
        /// The encoder's message.
        problem: String,
    },
    /// A depth image in another pixel format.
    #[error(
        "depth image has {found} pixels, expected 16-bit grey ones (PNG, TIFF, PGM) or 32-bit floats in metres (TIFF, OpenEXR){}",
        coarse(found)
    )]
    DepthFormat {
        /// For example `8-bit RGB`.
        found: String,
    },
    /// A kind of event that recordings do not hold.
    #[error("the event of {:.3} s is of a kind that recordings do not hold", stamp.as_secs())]
    UnknownEvent {
        /// Stamp of the event.
        stamp: trundle_core::Stamp,
    },
    /// Colour and depth do not fit together, or a size is not accepted.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}

/// Reason why a format with few bits is refused.
fn coarse(found: &str) -> &'static str {
    if found.starts_with("8-bit ") { ": 8 bits are too coarse for a depth" } else { "" }
}

impl CodecError {
    pub(crate) fn decode(kind: &'static str, problem: impl ToString) -> Self {
        Self::Decode { kind, problem: problem.to_string() }
    }

    pub(crate) fn encode(kind: &'static str, problem: impl ToString) -> Self {
        Self::Encode { kind, problem: problem.to_string() }
    }
}

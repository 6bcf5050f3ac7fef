//! A keyframe of the window.

use super::error_process::{ErrorStart, ErrorStep};
use super::factors::{ScanFactor, VisualFactor};
use super::preintegration::Preintegrated;
use super::state::ChainState;
use trundle_core::Stamp;

/// A keyframe: a stamp with its unknowns, the link from the previous keyframe, and its measurements.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Keyframe {
    pub(crate) stamp: Stamp,
    pub(crate) state: ChainState,
    /// Motion from the previous keyframe.
    pub(crate) motion: Preintegrated,
    /// Step of the visual error from the previous keyframe.
    pub(crate) error: ErrorStep,
    /// Probability that the last recognised place, at this keyframe or earlier, is correct.
    pub(crate) trust: f64,
    pub(crate) visual: Option<VisualFactor>,
    pub(crate) scan: Option<ScanFactor>,
}

impl Keyframe {
    /// Trust after this keyframe, given the trust before.
    pub(crate) fn trust_after(&self, before: f64) -> f64 {
        match self.error.start {
            Some(ErrorStart::Place(switch)) => switch.weight,
            Some(ErrorStart::NewMap) => 1.0,
            None => before,
        }
    }
}

//! Reasons why a request does not reach the run.

use thiserror::Error;
use trundle_core::Invalid;

/// Largest number of requests that wait for the run. A run takes one at each step. Source: ours.
pub(super) const MAX_WAITING_REQUESTS: usize = 64;

/// Reason why a request does not reach the run.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum OperatorError {
    /// A number of the command is not finite or outside its range.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// Requests arrive faster than the run processes them.
    #[error("{MAX_WAITING_REQUESTS} requests wait for the robot: send fewer")]
    Busy,
    /// A person has driven without release since a stop.
    #[error("the robot was stopped: release the control, then drive again")]
    Stopped,
    /// The run is over.
    #[error("the run is over")]
    Over,
    /// Zones or places could not be written to their file.
    #[error("the change applies until the run ends and is not saved: {0}")]
    NotKept(String),
    /// No place has this name.
    #[error("no place '{name}'; there are: {}", if known.is_empty() { "none" } else { known })]
    NoPlace {
        /// The name.
        name: String,
        /// The known names.
        known: String,
    },
}

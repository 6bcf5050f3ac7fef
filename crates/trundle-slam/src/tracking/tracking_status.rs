//! Tracking status of a frame.

use serde::{Deserialize, Serialize};

/// Tracking status of the last frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tracking {
    /// Located against the landmark map.
    Ok,
    /// Located, but by few landmarks: the covariance is large.
    Weak,
    /// The frame was not located: the pose is the last one, moved by the given prior.
    DeadReckoning,
    /// The frame was not located and has no prior: the pose is the last one.
    Lost,
}

impl Tracking {
    /// Whether the pose comes from the image.
    pub fn is_located(self) -> bool {
        matches!(self, Self::Ok | Self::Weak)
    }
}

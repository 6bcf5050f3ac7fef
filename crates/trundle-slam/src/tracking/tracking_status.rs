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
    /// Not located: the pose is the last one moved by the given prior.
    DeadReckoning,
    /// Not located and no prior: the pose stays.
    Lost,
}

impl Tracking {
    /// Whether the pose comes from the image.
    pub fn is_located(self) -> bool {
        matches!(self, Self::Ok | Self::Weak)
    }
}

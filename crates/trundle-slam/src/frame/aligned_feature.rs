//! Position of a feature after alignment with a reference patch.

use trundle_core::Vector2;
use trundle_vision::Keypoint;

/// Position of a feature after alignment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aligned {
    /// Raw px.
    pub raw: Vector2,
    /// Rectified px.
    pub pixel: Vector2,
    /// Standard deviation of either coordinate, px.
    pub sigma: f64,
    /// Whether a reference patch fits there; else the position is the extractor's.
    pub is_aligned: bool,
}

/// Position of a keypoint in the distorted image, px.
pub(crate) fn raw(keypoint: &Keypoint) -> Vector2 {
    Vector2::new(f64::from(keypoint.x), f64::from(keypoint.y))
}

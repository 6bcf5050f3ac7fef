//! A calibration in the settings, for cameras whose library reports none.

use trundle_core::{PinholeCamera, Pose3};

/// Intrinsics and extrinsics of a pair of cameras.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RgbdCalibration {
    /// The colour camera.
    pub color: PinholeCamera,
    /// The depth camera.
    pub depth: PinholeCamera,
    /// Pose of the depth camera in the colour camera's frame; `None` if depth comes registered to colour.
    pub color_from_depth: Option<Pose3>,
}

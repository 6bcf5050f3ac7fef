//! Result of a loop closure.

use crate::ids::KeyframeId;
use trundle_core::Pose3;

/// A place seen again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopClosure {
    /// The new keyframe at the place.
    pub keyframe: KeyframeId,
    /// The old keyframe at the place.
    pub seen_before: KeyframeId,
    /// Number of points of the old place found again.
    pub points: usize,
    /// Correction of the camera's pose: `new_from_old` in the visual frame.
    pub correction: Pose3,
}

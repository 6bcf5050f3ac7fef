//! Result of a loop closure.

use crate::ids::KeyframeId;
use trundle_core::Pose3;

/// A place seen again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopClosure {
    /// The keyframe that saw it again.
    pub keyframe: KeyframeId,
    /// The keyframe that had seen it.
    pub seen_before: KeyframeId,
    /// Points of the old place found again.
    pub points: usize,
    /// How the camera's pose changed: `new_from_old` in the visual frame.
    pub correction: Pose3,
}

//! The place of a keyframe in the spanning tree.

use crate::ids::KeyframeId;

/// Node of a keyframe in the spanning tree. Its parent is the keyframe with the largest number of common landmarks at its creation
/// \[MurArtal17\]. The first keyframe is the root.
#[derive(Debug, Clone, Default)]
pub(crate) struct TreeNode {
    pub parent: Option<KeyframeId>,
    /// Whether the keyframe shared no landmark with its parent, the previous keyframe: the first keyframe of a merged map, or one placed by
    /// odometry alone.
    pub shares_no_landmark: bool,
    pub children: Vec<KeyframeId>,
    /// Keyframes that close a loop with this one.
    pub loops: Vec<KeyframeId>,
    /// Removed keyframes whose successor this one is.
    pub successor_of: Vec<KeyframeId>,
}

//! The place of a keyframe in the spanning tree.

use crate::ids::KeyframeId;

/// Position of a keyframe in the spanning tree: its parent is the keyframe it shared most landmarks with when it was made
/// \[MurArtal17\]. The first keyframe is the root.
#[derive(Debug, Clone, Default)]
pub(crate) struct TreeNode {
    pub parent: Option<KeyframeId>,
    /// Whether it shared no landmark with its parent, which merely is the keyframe before: the first of a merged map, or one
    /// made by odometry alone.
    pub is_astray: bool,
    pub children: Vec<KeyframeId>,
    /// Keyframes with which it closes a loop.
    pub loops: Vec<KeyframeId>,
    /// Removed keyframes that it took over.
    pub successor_of: Vec<KeyframeId>,
}

//! The place of a keyframe in the spanning tree.

use crate::ids::KeyframeId;

/// Where a keyframe stands in the spanning tree: its parent is the keyframe it shared most landmarks with when it was
/// made \[MurArtal17\]. The first keyframe is the root.
#[derive(Debug, Clone, Default)]
pub(crate) struct TreeNode {
    pub parent: Option<KeyframeId>,
    /// Whether nothing it saw led to its parent, which merely is the one before: the first of a map that was taken over, or one made
    /// in the dark.
    pub is_astray: bool,
    pub children: Vec<KeyframeId>,
    /// Keyframes in which it found its place again, or which found theirs in it: the loops it closes.
    pub loops: Vec<KeyframeId>,
    /// Forgotten keyframes whose heir it is.
    pub successor_of: Vec<KeyframeId>,
}

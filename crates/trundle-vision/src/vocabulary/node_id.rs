//! The number of a node of a vocabulary.

/// A node of a `Vocabulary`'s tree; a leaf is a word. The root is 0, and parents come before their children.
pub type NodeId = u32;

//! A node of the hierarchy: eight boxes side by side.

/// Boxes side by side in a node. Source: ours, the width of a register of AVX2.
pub(crate) const WIDTH: usize = 8;

/// Marks a [`Node`]'s link to a leaf. Source: ours.
pub(super) const LEAF: u32 = 1 << 31;

/// Up to eight boxes: axis by axis, box by box.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct Node {
    pub(crate) low: [[f32; WIDTH]; 3],
    pub(crate) high: [[f32; WIDTH]; 3],
    /// A node, or with [`LEAF`] a leaf.
    pub(super) links: [u32; WIDTH],
    /// Number of children in use; the boxes of the others are empty.
    pub(super) count: u32,
}

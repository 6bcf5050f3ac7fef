//! A marker that was found in an image.

use trundle_core::Vector2;

/// A marker in an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tag {
    /// Number of the marker in its family.
    pub id: usize,
    /// Corners of the black square, px, seen from the front with the marker upright: upper left, upper right, lower right, lower left.
    pub corners: [Vector2; 4],
    /// Number of cells that differ from the family's marker, 0 to 2.
    pub wrong_cells: u32,
}

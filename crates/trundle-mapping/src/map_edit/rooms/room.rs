//! A room.

use trundle_core::Vector2;

/// A room.
#[derive(Debug, Clone, PartialEq)]
pub struct Room {
    /// Outer ring, counter-clockwise, then holes, clockwise; corners of cells, map frame \[m\]. The last corner of a ring is not repeated.
    pub rings: Vec<Vec<Vector2>>,
    /// Area of the cells \[m^2\].
    pub area_m2: f64,
    /// The place farthest from walls \[m\].
    pub center: Vector2,
}

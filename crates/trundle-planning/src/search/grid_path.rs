//! A path on the grid: dense and as waypoints.

use trundle_core::Vector2;

/// A path on the grid.
pub(crate) struct GridPath {
    pub(crate) raw: Vec<Vector2>,
    pub(crate) points: Vec<Vector2>,
    pub(crate) fell_back: bool,
}

impl GridPath {
    pub(crate) fn new(raw: Vec<Vector2>, points: Vec<Vector2>) -> Self {
        Self { raw, points, fell_back: false }
    }

    /// Appends a path that begins at the end of this one.
    pub(crate) fn extend(&mut self, next: Self) {
        self.raw.extend(next.raw.into_iter().skip(1));
        self.points.extend(next.points.into_iter().skip(1));
        self.fell_back |= next.fell_back;
    }
}

//! Lengths and directions in the plane.

use trundle_core::Vector2;

/// The length of a polyline, m.
pub(crate) fn polyline_length(points: &[Vector2]) -> f64 {
    points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}

/// The direction of a vector, rad.
pub(crate) fn bearing(vector: Vector2) -> f64 {
    vector.y.atan2(vector.x)
}

//! Points, segments and squares in the plane.

use trundle_core::Vector2;

/// From the nearest point of a square (`centre`, `half` side, m) to `point`; zero inside.
pub(crate) fn box_gap(point: Vector2, centre: Vector2, half: f64) -> Vector2 {
    let off = point - centre;
    Vector2::new(off.x - off.x.clamp(-half, half), off.y - off.y.clamp(-half, half))
}

/// The point of the segment `a`-`b` nearest to `p`.
pub(crate) fn nearest_on_segment(p: Vector2, a: Vector2, b: Vector2) -> Vector2 {
    let along = b - a;
    let squared = along.norm_squared();
    if squared == 0.0 {
        return a;
    }
    a + along * ((p - a).dot(&along) / squared).clamp(0.0, 1.0)
}

/// The nearest pair (on the segment `a`-`b`, on the square) when the two do not meet: one of the two is a corner.
pub(crate) fn segment_to_square(a: Vector2, b: Vector2, centre: Vector2, half: f64) -> (Vector2, Vector2) {
    let mut best = (a, a - box_gap(a, centre, half));
    let mut consider = |on_segment: Vector2, on_square: Vector2| {
        if (on_segment - on_square).norm_squared() < (best.0 - best.1).norm_squared() {
            best = (on_segment, on_square);
        }
    };
    consider(b, b - box_gap(b, centre, half));
    for (sx, sy) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let corner = centre + Vector2::new(sx, sy) * half;
        consider(nearest_on_segment(corner, a, b), corner);
    }
    best
}

/// The length of a polyline, m.
pub(crate) fn polyline_length(points: &[Vector2]) -> f64 {
    points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}

/// The direction of a vector, rad.
pub(crate) fn bearing(vector: Vector2) -> f64 {
    vector.y.atan2(vector.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_pairs_are_on_faces_and_corners() {
        let centre = Vector2::zeros();
        let (s, q) = segment_to_square(Vector2::new(-5.0, 2.0), Vector2::new(5.0, 2.5), centre, 1.0);
        assert!((q - Vector2::new(-1.0, 1.0)).norm() < 1e-12 && (s - q).norm() < 1.21);
        let (s, q) = segment_to_square(Vector2::new(3.0, 0.2), Vector2::new(4.0, 0.2), centre, 1.0);
        assert_eq!((s, q), (Vector2::new(3.0, 0.2), Vector2::new(1.0, 0.2)));
    }
}

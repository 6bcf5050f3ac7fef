//! Squares, the cells of a grid: distances from points, segments and convex polygons.

use crate::convex_polygon::sides;
use crate::segment::Segment;
use trundle_core::Vector2;

/// The vector from the nearest point of a square (`centre`, `half` side, m) to `point`; zero inside.
pub fn point_to_square(point: Vector2, centre: Vector2, half: f64) -> Vector2 {
    let off = point - centre;
    Vector2::new(off.x - off.x.clamp(-half, half), off.y - off.y.clamp(-half, half))
}

/// The nearest pair (on the segment `a`-`b`, on the square) when the two do not meet: one of the two is a corner.
pub fn segment_to_square(a: Vector2, b: Vector2, centre: Vector2, half: f64) -> (Vector2, Vector2) {
    let mut best = (a, a - point_to_square(a, centre, half));
    let mut consider = |on_segment: Vector2, on_square: Vector2| {
        if (on_segment - on_square).norm_squared() < (best.0 - best.1).norm_squared() {
            best = (on_segment, on_square);
        }
    };
    consider(b, b - point_to_square(b, centre, half));
    for (sx, sy) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let corner = centre + Vector2::new(sx, sy) * half;
        consider(Segment { a, b }.nearest(corner), corner);
    }
    best
}

/// The distance between a convex polygon and a square, or `cap` if that is less; 0 if they overlap or touch.
pub fn polygon_to_square(polygon: &[Vector2], centre: Vector2, half: f64, cap: f64) -> f64 {
    // Separating axes: those of the square, then those of the polygon's sides.
    let low = polygon.iter().fold(polygon[0], |low, c| low.inf(c));
    let high = polygon.iter().fold(polygon[0], |high, c| high.sup(c));
    let apart =
        point_to_square(centre, (low + high) / 2.0, 0.0).abs() - (high - low) / 2.0 - Vector2::repeat(half);
    let mut axis = apart.x.max(apart.y);
    for (a, b) in sides(polygon) {
        let Some(normal) = Vector2::new(b.y - a.y, a.x - b.x).try_normalize(1e-12) else { continue };
        axis = axis.max(normal.dot(&(centre - a)) - half * (normal.x.abs() + normal.y.abs()));
    }
    if axis >= cap {
        return cap;
    }
    if axis <= 0.0 {
        return 0.0;
    }
    let to_side = |(a, b): (Vector2, Vector2)| {
        let (p, q) = segment_to_square(a, b, centre, half);
        (p - q).norm()
    };
    sides(polygon).map(to_side).fold(cap, f64::min)
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

//! The lower convex hull of points in the plane.

/// A point: x and y.
pub(super) type Point = (f64, f64);

/// The corners of the lower hull of points sorted by x, from left to right.
pub(super) fn lower_hull(points: impl Iterator<Item = Point>) -> Vec<Point> {
    let mut hull: Vec<Point> = Vec::new();
    for point in points {
        while let [.., before, last] = hull[..] {
            if turn(before, last, point) > 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(point);
    }
    hull
}

/// The slope of the hull's edge above or below `x`; zero for fewer than two corners.
pub(super) fn slope_at(hull: &[Point], x: f64) -> f64 {
    let edges = || hull.windows(2);
    let edge = edges().find(|edge| edge[1].0 >= x).or_else(|| edges().last());
    edge.map_or(0.0, |edge| (edge[1].1 - edge[0].1) / (edge[1].0 - edge[0].0))
}

/// Positive when a, b, c turn counter-clockwise.
fn turn(a: Point, b: Point, c: Point) -> f64 {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_lies_below_all_points() {
        let points = [(0.0, 1.0), (1.0, 3.0), (2.0, 0.0), (3.0, 0.5), (4.0, 0.2), (5.0, 2.0)];
        let hull = lower_hull(points.into_iter());
        assert_eq!(hull, [(0.0, 1.0), (2.0, 0.0), (4.0, 0.2), (5.0, 2.0)]);
        assert!((slope_at(&hull, 2.5) - 0.1).abs() < 1e-12);
        assert!((slope_at(&hull, 9.0) - 1.8).abs() < 1e-12);
        assert_eq!(slope_at(&hull[..1], 0.0), 0.0);
    }
}

//! Outlines of solids and footprints on the floor, and convex hulls.

use super::region::Region;
use trundle_core::{Footprint, Pose2, Vector2};

/// A convex region of the plane that owns its corners; see [`Region`].
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Outline {
    corners: Vec<Vector2>,
    radius: f64,
}

impl Outline {
    /// The region within `radius` m of a convex polygon; `corners` counter-clockwise, at least one.
    pub(crate) fn new(corners: Vec<Vector2>, radius: f64) -> Self {
        debug_assert!(!corners.is_empty(), "an outline needs a corner");
        Self { corners, radius }
    }

    /// A robot's footprint standing at `pose`.
    pub(crate) fn of_footprint(footprint: &Footprint, pose: Pose2) -> Self {
        match footprint {
            Footprint::Disc { radius } => Self::new(vec![pose.position()], *radius),
            Footprint::Polygon { corners } => {
                Self::new(corners.iter().map(|&corner| pose.transform(corner)).collect(), 0.0)
            }
        }
    }

    pub(crate) fn region(&self) -> Region<'_> {
        Region { corners: &self.corners, radius: self.radius }
    }
}

/// The convex hull of a few points, counter-clockwise and without corners on its sides: one point, two, or a polygon
/// (Andrew's monotone chain). `hull` is overwritten.
pub(super) fn fill_hull(points: &mut [Vector2], hull: &mut Vec<Vector2>) {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    hull.clear();
    for pass in 0..2 {
        let start = hull.len();
        for i in 0..points.len() {
            let point = points[if pass == 0 { i } else { points.len() - 1 - i }];
            while hull.len() >= start + 2 && turn(hull[hull.len() - 2], hull[hull.len() - 1], point) <= 0.0 {
                hull.pop();
            }
            hull.push(point);
        }
        hull.pop();
    }
    if hull.is_empty() || hull.iter().all(|point| *point == hull[0]) {
        hull.clear();
        hull.extend(points.first());
    }
}

/// Twice the area of a triangle, positive when it is counter-clockwise.
fn turn(a: Vector2, b: Vector2, c: Vector2) -> f64 {
    (b - a).perp(&(c - b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hull(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let mut points: Vec<Vector2> = points.iter().map(|&(x, y)| Vector2::new(x, y)).collect();
        let mut hull = Vec::new();
        fill_hull(&mut points, &mut hull);
        hull.iter().map(|p| (p.x, p.y)).collect()
    }

    #[test]
    fn hulls_of_points_lines_and_polygons() {
        assert_eq!(hull(&[(1.0, 2.0), (1.0, 2.0), (1.0, 2.0)]), [(1.0, 2.0)]);
        assert_eq!(hull(&[(2.0, 2.0), (0.0, 0.0), (1.0, 1.0)]), [(0.0, 0.0), (2.0, 2.0)]);
        assert_eq!(hull(&[(0.0, 3.0), (0.0, 1.0), (0.0, 2.0)]), [(0.0, 1.0), (0.0, 3.0)]);
        assert_eq!(
            hull(&[(0.0, 1.0), (1.0, 1.0), (0.5, 0.5), (1.0, 0.0), (0.0, 0.0)]),
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
        );
    }
}

//! A convex free polygon around a straight piece of way.
//!
//! Idea: between the segment and each obstacle's square, both convex, the nearest pair of points spans a separating
//! plane; moved off the obstacle by the room wanted, and never past the segment, it bounds a region whose every point
//! keeps that room from that obstacle. Obstacles are taken nearest first; one that lies behind a plane already is done.
//! With the control points of a Bezier piece inside, the whole piece keeps the room, by the convex hull.

use crate::geometry::{nearest_on_segment, segment_to_square};
use crate::space::Space;
use trundle_core::Vector2;

/// The half-plane normal . p <= offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPlane {
    /// Unit normal, outward.
    pub normal: Vector2,
    /// Metres.
    pub offset: f64,
}

impl HalfPlane {
    /// The corners of the polygon that half-planes bound, in order; empty where they have nothing in common. What they leave
    /// open ends 10 km off.
    pub fn outline(planes: &[Self]) -> Vec<Vector2> {
        const OPEN: f64 = 1e4;
        let square = [(-OPEN, -OPEN), (OPEN, -OPEN), (OPEN, OPEN), (-OPEN, OPEN)];
        let whole = square.map(|(x, y)| Vector2::new(x, y)).to_vec();
        planes.iter().fold(whole, |corners, plane| plane.cut(&corners))
    }

    /// What of a convex polygon lies within.
    fn cut(&self, corners: &[Vector2]) -> Vec<Vector2> {
        let beyond = |p: &Vector2| self.normal.dot(p) - self.offset;
        let mut kept = Vec::with_capacity(corners.len() + 1);
        for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let (from, to) = (beyond(a), beyond(b));
            if from <= 0.0 {
                kept.push(*a);
            }
            if from * to < 0.0 {
                kept.push(a + (b - a) * (from / (from - to)));
            }
        }
        kept
    }
}

/// The polygon around the free segment `a`-`b` within `reach` m of its bounding box: room of `want` m wherever the
/// segment itself has more, else most of what the segment has.
pub(crate) fn corridor(space: &Space<'_>, a: Vector2, b: Vector2, reach: f64, want: f64) -> Vec<HalfPlane> {
    let low = a.inf(&b) - Vector2::repeat(reach);
    let high = a.sup(&b) + Vector2::repeat(reach);
    let half = space.field.geometry().resolution / 2.0;
    let mut planes = frame(space, a, b, (low, high), want);
    let mut left = obstacles(space, a, b, low, high, want);
    while let Some((_, centre)) = left.iter().min_by(|(d, _), (e, _)| d.total_cmp(e)).copied() {
        let (on_segment, on_square) = segment_to_square(a, b, centre, half);
        let gap = on_square - on_segment;
        let Some(normal) = gap.try_normalize(1e-9) else {
            left.retain(|(_, other)| *other != centre);
            continue;
        };
        let face = normal.dot(&on_square);
        planes.push(HalfPlane { normal, offset: face - kept(space, gap.norm(), want) });
        let reach = half * (normal.x.abs() + normal.y.abs());
        left.retain(|(_, other)| normal.dot(other) - reach < face - 1e-9);
    }
    planes
}

/// The room that a side keeps where the segment has `distance`: `want`, or less where the segment itself has hardly more;
/// a corridor that the segment leans on would force every corner of the way on the curve.
fn kept(space: &Space<'_>, distance: f64, want: f64) -> f64 {
    const SHARE: f64 = 0.6;
    let spare = (distance - space.radius).max(0.0);
    want.min(distance - spare * (1.0 - SHARE))
}

/// The sides of the window, cut to the grid.
fn frame(
    space: &Space<'_>,
    a: Vector2,
    b: Vector2,
    (low, high): (Vector2, Vector2),
    want: f64,
) -> Vec<HalfPlane> {
    let (grid_low, grid_high) = space.field.extent();
    let inset = if space.field.is_walled() { want } else { 0.0 };
    let low = low.sup(&(grid_low + Vector2::repeat(inset))).inf(&a.inf(&b));
    let high = high.inf(&(grid_high - Vector2::repeat(inset))).sup(&a.sup(&b));
    vec![
        HalfPlane { normal: Vector2::new(1.0, 0.0), offset: high.x },
        HalfPlane { normal: Vector2::new(-1.0, 0.0), offset: -low.x },
        HalfPlane { normal: Vector2::new(0.0, 1.0), offset: high.y },
        HalfPlane { normal: Vector2::new(0.0, -1.0), offset: -low.y },
    ]
}

/// The outer squares of obstacles that could come within `want` of the window, and how far their middles are from the
/// segment, squared.
fn obstacles(
    space: &Space<'_>,
    a: Vector2,
    b: Vector2,
    low: Vector2,
    high: Vector2,
    want: f64,
) -> Vec<(f64, Vector2)> {
    let half = space.field.geometry().resolution / 2.0;
    let wide = Vector2::repeat(want + half);
    let mut found = Vec::new();
    space.field.for_obstacle_rims_in(low - wide, high + wide, |centre| {
        found.push(((centre - nearest_on_segment(centre, a, b)).norm_squared(), centre));
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_planes_bound_a_polygon() {
        let plane = |x: f64, y: f64, offset| HalfPlane { normal: Vector2::new(x, y), offset };
        let slope = std::f64::consts::FRAC_1_SQRT_2;
        let triangle = [plane(-1.0, 0.0, 0.0), plane(0.0, -1.0, 0.0), plane(slope, slope, slope)];
        let mut corners = HalfPlane::outline(&triangle);
        corners.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let expected = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)];
        assert!(
            corners.iter().zip(expected).all(|(c, (x, y))| (c - Vector2::new(x, y)).norm() < 1e-9),
            "{corners:?}"
        );
        assert!(
            corners.len() == 3
                && HalfPlane::outline(&[plane(1.0, 0.0, -1.0), plane(-1.0, 0.0, -1.0)]).is_empty()
        );
    }
}

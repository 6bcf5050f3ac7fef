//! A convex free polygon around a straight segment of a path.
//!
//! Idea: between the segment and each occupied cell, both convex, the nearest pair of points spans a separating line. The line is shifted
//! from the obstacle by the wanted clearance, but never past the segment. Every point on the segment's side of the line has this clearance
//! from the obstacle. Obstacles are processed nearest first; one behind an existing line is skipped. A Bezier piece with its control points
//! inside the polygon has the clearance everywhere, by the convex hull property.

use crate::curve::half_plane::HalfPlane;
use crate::search::configuration_space::ConfigurationSpace;
use trundle_collision::Segment;
use trundle_collision::square::segment_to_square;
use trundle_core::Vector2;

/// The polygon around the free segment `a`-`b` within `reach` m of its bounding box. The clearance is `want` m if the segment itself has
/// more, else most of the segment's own clearance.
pub(crate) fn corridor(
    space: &ConfigurationSpace<'_>,
    a: Vector2,
    b: Vector2,
    reach: f64,
    want: f64,
) -> Vec<HalfPlane> {
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
        planes.push(HalfPlane { normal, offset: face - side_clearance(space, gap.norm(), want) });
        let reach = half * (normal.x.abs() + normal.y.abs());
        left.retain(|(_, other)| normal.dot(other) - reach < face - 1e-9);
    }
    planes
}

/// Share of the segment's spare clearance that a side may use up. A corridor on the segment itself would force every corner of
/// the path on the curve. Source: ours.
const MAX_SPARE_SHARE: f64 = 0.6;

/// The clearance of a side at `distance` m from the segment: `want`, or less if the segment itself has only slightly more.
fn side_clearance(space: &ConfigurationSpace<'_>, distance: f64, want: f64) -> f64 {
    let spare = (distance - space.radius).max(0.0);
    want.min(distance - spare * (1.0 - MAX_SPARE_SHARE))
}

/// The sides of the window, clipped to the grid.
fn frame(
    space: &ConfigurationSpace<'_>,
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

/// The boundary cells of obstacles that could come within `want` of the window, with the squared distances of their centres from
/// the segment.
fn obstacles(
    space: &ConfigurationSpace<'_>,
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
        found.push(((centre - Segment { a, b }.nearest(centre)).norm_squared(), centre));
    });
    found
}

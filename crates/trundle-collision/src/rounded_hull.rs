//! A convex hull with rounded corners: the shape of a footprint with a margin.

use crate::segment::Segment;
use trundle_core::{Footprint, Pose2, Vector2};

/// Smallest radius of the corners, m: the closed forms need corners with a radius. A smaller margin counts as no margin. Source: ours.
pub const MIN_CORNER_RADIUS_M: f64 = 1e-6;

/// Largest overlap that counts as contact and is free, m: rounding of poses and corners. Planner and docking share this value, so both pass
/// the same gaps. Source: ours.
pub const CONTACT_TOLERANCE_M: f64 = 1e-6;

/// A footprint with a margin: a convex core and every point within `radius` of it, base frame, m.
///
/// A disc is a core of one point. A point at exactly `radius` touches and does not overlap.
#[derive(Debug, Clone, PartialEq)]
pub struct RoundedHull {
    pub(crate) core: Vec<Corner>,
    pub(crate) edges: Vec<Edge>,
    pub(crate) radius: f64,
    /// Largest distance of a point from the base's origin, m.
    pub(crate) outer: f64,
    /// Radius around the base's origin that is inside, m; 0 when the origin is outside.
    pub(crate) inner: f64,
}

/// A corner of the core.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    pub at: Vector2,
    /// Distance from the base's origin, m.
    pub distance: f64,
    /// Bearing from the base's origin, rad.
    pub bearing: f64,
}

/// A side of the core, counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Edge {
    pub side: Segment,
    /// Unit, outward.
    pub normal: Vector2,
    pub normal_bearing: f64,
    /// The core is the set `normal . x <= offset`.
    pub offset: f64,
    /// Length, m.
    pub length: f64,
}

impl Edge {
    /// Unit, from the side's first end to its second.
    pub fn along(&self) -> Vector2 {
        Vector2::new(-self.normal.y, self.normal.x)
    }
}

impl RoundedHull {
    /// A footprint grown by `margin` (m), or shrunk when the margin is negative. A footprint without remaining area becomes a point at the
    /// axle. A margin below [`MIN_CORNER_RADIUS_M`] counts as 0: contact is free, up to [`CONTACT_TOLERANCE_M`].
    pub fn new(footprint: &Footprint, margin: f64) -> Self {
        let exact = Self::exact(footprint);
        if margin >= MIN_CORNER_RADIUS_M {
            return exact.grown(margin);
        }
        exact
            .shrunk(CONTACT_TOLERANCE_M - margin.min(0.0))
            .unwrap_or_else(|| Self::from_core(&[Vector2::zeros()], MIN_CORNER_RADIUS_M))
    }

    /// The footprint itself: the corners of a polygon are sharp. It suits [`RoundedHull::signed_distance`] and
    /// [`arc_contact`](crate::arc_contact), which need no rounded corners.
    pub fn exact(footprint: &Footprint) -> Self {
        match footprint {
            Footprint::Disc { radius } => Self::from_core(&[Vector2::zeros()], *radius),
            Footprint::Polygon { corners } => Self::from_core(&without_duplicates(corners), 0.0),
        }
    }

    /// Whether the hull is a disc around the base's origin: a disc turns in place without contact.
    pub fn is_disc(&self) -> bool {
        self.edges.is_empty()
    }

    /// Distance of a point of the base frame from the boundary, m; negative inside.
    pub fn signed_distance(&self, p: Vector2) -> f64 {
        self.core_offset(p).0 - self.radius
    }

    /// Distance of a point from the core, m, negative inside, and the unit direction away from the core.
    pub(crate) fn core_offset(&self, p: Vector2) -> (f64, Vector2) {
        let inside = self.edges.iter().map(|edge| ((p - edge.side.a).dot(&edge.normal), edge.normal));
        match inside.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((depth, outward)) if depth <= 0.0 => (depth, outward),
            _ => {
                let ends = self.edges.iter().map(|edge| edge.side.nearest(p)).chain([self.core[0].at]);
                let away = ends.map(|at| p - at).min_by(|a, b| a.norm().total_cmp(&b.norm()));
                let away = away.unwrap_or(p);
                (away.norm(), away.try_normalize(1e-12).unwrap_or(Vector2::zeros()))
            }
        }
    }

    /// The set of points within `by` (m) of this hull.
    pub(crate) fn grown(&self, by: f64) -> Self {
        let core: Vec<Vector2> = self.core.iter().map(|c| c.at).collect();
        Self::from_core(&core, self.radius + by)
    }

    /// The part of this hull with a distance of at least `depth` (m) from the outside; `None` if no area remains.
    ///
    /// The part is exact along the sides and too small at the corners, by [`MIN_CORNER_RADIUS_M`]: it never contains a point too many.
    pub fn shrunk(&self, depth: f64) -> Option<Self> {
        let core: Vec<Vector2> = self.core.iter().map(|c| c.at).collect();
        if self.radius - depth >= MIN_CORNER_RADIUS_M {
            return Some(Self::from_core(&core, self.radius - depth));
        }
        let inset = depth - self.radius + MIN_CORNER_RADIUS_M;
        let left = self.edges.iter().fold(core, |core, edge| cut(&core, edge.normal, edge.offset - inset));
        (left.len() >= 3).then(|| Self::from_core(&without_duplicates(&left), MIN_CORNER_RADIUS_M))
    }

    /// The smallest such hull that contains this hull and the axle.
    pub(crate) fn with_axle(&self) -> Self {
        if self.edges.is_empty() || self.edges.iter().all(|edge| edge.offset >= 0.0) {
            return self.clone();
        }
        // Sides that face the axle are replaced by two sides that end at the axle.
        let n = self.edges.len();
        let faces = |i: usize| self.edges[i % n].offset < 0.0;
        let first = (0..n).find(|&i| faces(i) && !faces(i + n - 1)).unwrap_or(0);
        let count = (0..n).take_while(|k| faces(first + k)).count();
        let mut corners = vec![Vector2::zeros()];
        corners.extend((count..=n).map(|k| self.core[(first + k) % n].at));
        Self::from_core(&corners, self.radius)
    }

    fn from_core(corners: &[Vector2], radius: f64) -> Self {
        let core: Vec<Corner> =
            corners.iter().map(|&at| Corner { at, distance: at.norm(), bearing: at.y.atan2(at.x) }).collect();
        let next = corners.iter().cycle().skip(1);
        let sides = corners.iter().zip(next).filter(|_| corners.len() > 1);
        let edges: Vec<Edge> = sides.map(|(&a, &b)| edge(a, b)).collect();
        let outer = core.iter().map(|c| c.distance).fold(0.0, f64::max) + radius;
        let mut hull = Self { core, edges, radius, outer, inner: 0.0 };
        hull.inner = if hull.edges.is_empty() {
            radius
        } else if hull.core_contains(Vector2::zeros()) {
            hull.edges.iter().map(|e| e.offset + radius).fold(f64::INFINITY, f64::min)
        } else {
            // An axle outside the core is in the margin, or outside the hull.
            (radius - hull.core_distance(&Segment::point(Vector2::zeros()))).max(0.0)
        };
        hull
    }

    /// Largest distance of a point from the base's origin, m.
    pub fn outer_radius(&self) -> f64 {
        self.outer
    }

    /// Whether a segment, in the base frame, overlaps the hull.
    pub fn overlaps(&self, segment: &Segment) -> bool {
        let mut gap = f64::NEG_INFINITY;
        for edge in &self.edges {
            gap = gap.max(edge.normal.dot(&segment.a).min(edge.normal.dot(&segment.b)) - edge.offset);
        }
        if gap >= self.radius {
            return false;
        }
        let along = segment.b - segment.a;
        if along.norm_squared() > 0.0 {
            let normal = Vector2::new(-along.y, along.x).normalize();
            let (low, high) = self.core_extent(normal);
            let at = normal.dot(&segment.a);
            gap = gap.max(low - at).max(at - high);
        }
        if gap >= self.radius {
            return false;
        }
        // Separating axes are complete for a polygon and a segment: without a gap they meet.
        (gap < 0.0 && !self.edges.is_empty()) || self.core_distance(segment) < self.radius
    }

    /// The distance between the hull and a segment in the base frame, m; 0 when they overlap.
    pub fn distance(&self, segment: &Segment) -> f64 {
        (self.core_distance(segment) - self.radius).max(0.0)
    }

    /// Whether a point of the base frame is inside the core.
    pub fn core_contains(&self, p: Vector2) -> bool {
        !self.edges.is_empty() && self.edges.iter().all(|e| e.normal.dot(&p) <= e.offset)
    }

    /// The corners of the core at a pose of the base, map frame.
    pub fn corners_at(&self, pose: &Pose2) -> impl Iterator<Item = Vector2> + '_ {
        let pose = *pose;
        self.core.iter().map(move |c| pose.transform(c.at))
    }

    /// The distance between the core and a segment, m.
    pub fn core_distance(&self, segment: &Segment) -> f64 {
        if self.edges.is_empty() {
            return segment.distance(self.core[0].at);
        }
        if self.core_contains(segment.a) || self.core_contains(segment.b) {
            return 0.0;
        }
        if segment.is_point() {
            return self.edges.iter().map(|e| e.side.distance(segment.a)).fold(f64::INFINITY, f64::min);
        }
        self.edges.iter().map(|e| e.side.distance_to(segment)).fold(f64::INFINITY, f64::min)
    }

    /// Minimum and maximum of `normal . x` over the core.
    pub(crate) fn core_extent(&self, normal: Vector2) -> (f64, f64) {
        let along = self.core.iter().map(|c| normal.dot(&c.at));
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    }
}

fn edge(a: Vector2, b: Vector2) -> Edge {
    let along = (b - a).normalize();
    let normal = Vector2::new(along.y, -along.x);
    let (normal_bearing, offset, length) = (normal.y.atan2(normal.x), normal.dot(&a), (b - a).norm());
    Edge { side: Segment { a, b }, normal, normal_bearing, offset, length }
}

/// The part of a convex polygon with `normal . x <= offset`.
fn cut(corners: &[Vector2], normal: Vector2, offset: f64) -> Vec<Vector2> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (over_a, over_b) = (normal.dot(&a) - offset, normal.dot(&b) - offset);
        if over_a <= 0.0 {
            kept.push(a);
        }
        if (over_a < 0.0) != (over_b < 0.0) && over_a != 0.0 && over_b != 0.0 {
            kept.push(a + (b - a) * (over_a / (over_a - over_b)));
        }
    }
    kept
}

fn without_duplicates(corners: &[Vector2]) -> Vec<Vector2> {
    let n = corners.len();
    (0..n).filter(|&i| (corners[i] - corners[(i + 1) % n]).norm() > 1e-9).map(|i| corners[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn box_hull(margin: f64) -> RoundedHull {
        let corners = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)];
        let corners = corners.map(|(x, y)| Vector2::new(x, y)).to_vec();
        RoundedHull::new(&Footprint::polygon(corners).unwrap(), margin)
    }

    #[test]
    fn corners_are_rounded_and_sides_are_straight() {
        let hull = box_hull(0.1);
        let touches = |x, y| hull.overlaps(&Segment::point(Vector2::new(x, y)));
        assert!(touches(0.399, 0.0) && !touches(0.401, 0.0));
        assert!(touches(0.37, 0.27) && !touches(0.372, 0.272));
        let through = Segment { a: Vector2::new(-5.0, 0.0), b: Vector2::new(5.0, 0.1) };
        assert!(hull.overlaps(&through));
        assert!((hull.distance(&Segment::point(Vector2::new(0.6, 0.6))) - 0.4).abs() < 1e-12);
    }

    #[test]
    fn shrinking_reduces_the_margin_first_and_then_the_core() {
        assert!((box_hull(0.1).shrunk(0.05).unwrap().outer - (0.13_f64.sqrt() + 0.05)).abs() < 1e-12);
        let small = box_hull(0.01).shrunk(0.05).unwrap();
        let touches = |x, y| small.overlaps(&Segment::point(Vector2::new(x, y)));
        assert!(touches(0.2599, 0.0) && !touches(0.2601, 0.0) && touches(0.0, 0.1599));
        assert!(box_hull(0.01).shrunk(0.3).is_none());
    }
}

use trundle_core::{Footprint, Pose2, Vector2};

/// A convex region of the plane: a counter-clockwise polygon (or one point), grown by a radius.
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

    /// Metres between two regions; 0 when polygons overlap, less when it is their radii that overlap.
    pub(crate) fn clearance(&self, other: &Self) -> f64 {
        let overlap = holds(&self.corners, other.corners[0]) || holds(&other.corners, self.corners[0]);
        let gap = if overlap { 0.0 } else { self.polygon_gap(other) };
        gap - self.radius - other.radius
    }

    /// The lowest and the highest corner of the box around it.
    pub(crate) fn bounds(&self) -> (Vector2, Vector2) {
        let corner = |pick: fn(&Vector2, &Vector2) -> Vector2| {
            self.corners
                .iter()
                .copied()
                .reduce(|a, b| pick(&a, &b))
                .expect("invariant: an outline has a corner")
        };
        let low = corner(|a, b| a.inf(b)).add_scalar(-self.radius);
        (low, corner(|a, b| a.sup(b)).add_scalar(self.radius))
    }

    fn polygon_gap(&self, other: &Self) -> f64 {
        let mut least = f64::INFINITY;
        for a in edges(&self.corners) {
            for b in edges(&other.corners) {
                least = least.min(segment_gap(a, b));
            }
        }
        least
    }
}

type Segment = (Vector2, Vector2);

fn edges(corners: &[Vector2]) -> impl Iterator<Item = Segment> + '_ {
    (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]))
}

/// Whether a convex counter-clockwise polygon holds a point; a single point holds nothing.
fn holds(corners: &[Vector2], point: Vector2) -> bool {
    corners.len() > 2 && edges(corners).all(|(a, b)| (b - a).perp(&(point - a)) >= 0.0)
}

fn segment_gap(a: Segment, b: Segment) -> f64 {
    let side = |s: Segment, p: Vector2| (s.1 - s.0).perp(&(p - s.0));
    let crosses = |s: Segment, t: Segment| side(s, t.0) * side(s, t.1) < 0.0;
    if crosses(a, b) && crosses(b, a) {
        return 0.0;
    }
    point_gap(a.0, b).min(point_gap(a.1, b)).min(point_gap(b.0, a)).min(point_gap(b.1, a))
}

fn point_gap(p: Vector2, (a, b): Segment) -> f64 {
    let along = b - a;
    let length2 = along.norm_squared();
    let t = if length2 > 0.0 { ((p - a).dot(&along) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (p - a - along * t).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64) -> Outline {
        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
        Outline::new(corners.iter().map(|&(dx, dy)| Vector2::new(x + dx, y + dy)).collect(), 0.0)
    }

    #[test]
    fn clearances_are_those_of_elementary_geometry() {
        let disc = |x, y, r| Outline::new(vec![Vector2::new(x, y)], r);
        assert_eq!(square(0.0, 0.0).clearance(&square(3.0, 0.5)), 1.0);
        assert!((square(0.0, 0.0).clearance(&square(5.0, 6.0)) - 5.0).abs() < 1e-12);
        assert_eq!(square(0.0, 0.0).clearance(&square(0.5, 0.5)), 0.0);
        assert_eq!(square(0.0, 0.0).clearance(&disc(3.0, 0.0, 0.5)), 1.5);
        assert_eq!(disc(0.0, 0.0, 1.0).clearance(&disc(3.0, 4.0, 1.5)), 2.5);
        assert_eq!(square(0.0, 0.0).clearance(&disc(0.2, 0.0, 0.5)), -0.5);
    }

    #[test]
    fn a_plus_of_two_bars_overlaps_though_no_corner_is_inside() {
        let bar = |w: f64, h: f64| {
            let corners = [(w, h), (-w, h), (-w, -h), (w, -h)].map(|(x, y)| Vector2::new(x, y));
            Outline::new(corners.to_vec(), 0.0)
        };
        assert_eq!(bar(3.0, 0.1).clearance(&bar(0.1, 3.0)), 0.0);
        let footprint = Footprint::Polygon { corners: bar(0.3, 0.2).corners };
        let turned = Outline::of_footprint(&footprint, Pose2::new(2.0, 0.0, std::f64::consts::FRAC_PI_2));
        assert!((square(0.0, 0.0).clearance(&turned) - 0.8).abs() < 1e-12);
    }
}

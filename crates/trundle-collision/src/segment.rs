//! Line segments and points.

use trundle_core::Vector2;

/// A line segment between two points, m; a point when both are equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// One end.
    pub a: Vector2,
    /// The other end.
    pub b: Vector2,
}

impl Segment {
    /// A segment of one point.
    pub fn point(at: Vector2) -> Self {
        Self { a: at, b: at }
    }

    /// Whether both ends are equal.
    pub fn is_point(&self) -> bool {
        self.a == self.b
    }

    /// The point of the segment nearest to `p`.
    pub fn nearest(&self, p: Vector2) -> Vector2 {
        let along = self.b - self.a;
        let squared = along.norm_squared();
        if squared == 0.0 {
            return self.a;
        }
        self.a + along * ((p - self.a).dot(&along) / squared).clamp(0.0, 1.0)
    }

    /// The distance to a point, m.
    pub fn distance(&self, p: Vector2) -> f64 {
        (self.nearest(p) - p).norm()
    }

    /// The distance to another segment, m; 0 if they cross.
    pub fn distance_to(&self, other: &Self) -> f64 {
        if self.crosses(other) {
            return 0.0;
        }
        let ends = self.distance(other.a).min(self.distance(other.b));
        ends.min(other.distance(self.a)).min(other.distance(self.b))
    }

    fn crosses(&self, other: &Self) -> bool {
        let side = |s: &Self, p: Vector2| (s.b - s.a).perp(&(p - s.a));
        side(self, other.a) * side(self, other.b) < 0.0 && side(other, self.a) * side(other, self.b) < 0.0
    }

    /// The segment in a frame at `origin` that is turned counter-clockwise by the angle with this cosine and sine.
    pub fn in_frame(&self, origin: Vector2, cos: f64, sin: f64) -> Self {
        let turn = |p: Vector2| {
            let d = p - origin;
            Vector2::new(cos * d.x + sin * d.y, cos * d.y - sin * d.x)
        };
        Self { a: turn(self.a), b: turn(self.b) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_between_segments() {
        let s = |ax, ay, bx, by| Segment { a: Vector2::new(ax, ay), b: Vector2::new(bx, by) };
        assert_eq!(s(0., 0., 2., 0.).distance_to(&s(1., -1., 1., 1.)), 0.0);
        assert_eq!(s(0., 0., 2., 0.).distance_to(&s(1., 0.5, 1., 1.)), 0.5);
        assert_eq!(s(0., 0., 2., 0.).distance_to(&Segment::point(Vector2::new(5., 4.))), 5.0);
    }
}

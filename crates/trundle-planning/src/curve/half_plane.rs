//! Half-planes, and the polygons bounded by half-planes.

use trundle_core::Vector2;

/// The half-plane normal . p <= offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPlane {
    /// Unit normal, outward.
    pub normal: Vector2,
    /// Metres.
    pub offset: f64,
}

/// Distance at which an open side of a polygon is closed, m. Source: ours.
const OPEN_SIDE_M: f64 = 1e4;

impl HalfPlane {
    /// The corners of the polygon bounded by half-planes, in order; empty if their intersection is empty. Open sides end `OPEN_SIDE_M`
    /// away.
    pub fn outline(planes: &[Self]) -> Vec<Vector2> {
        let square = [
            (-OPEN_SIDE_M, -OPEN_SIDE_M),
            (OPEN_SIDE_M, -OPEN_SIDE_M),
            (OPEN_SIDE_M, OPEN_SIDE_M),
            (-OPEN_SIDE_M, OPEN_SIDE_M),
        ];
        let whole = square.map(|(x, y)| Vector2::new(x, y)).to_vec();
        planes.iter().fold(whole, |corners, plane| plane.cut(&corners))
    }

    /// The part of a convex polygon inside the half-plane.
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

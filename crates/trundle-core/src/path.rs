//! A path: a polyline in the map frame, without time.

use crate::{Invalid, Vector2};

/// A path: geometry without time. Straight pieces between points of the map frame, m.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    points: Vec<Vector2>,
}

impl Path {
    /// A path through `points` (map frame, m).
    ///
    /// # Errors
    /// When the path has no point, or a point is not finite.
    pub fn new(points: Vec<Vector2>) -> Result<Self, Invalid> {
        if points.is_empty() {
            return Err(Invalid::new("path points", 0, "", "1 or more"));
        }
        if let Some((i, p)) = points.iter().enumerate().find(|(_, p)| !(p.x.is_finite() && p.y.is_finite())) {
            let value = format!("({}, {})", p.x, p.y);
            return Err(Invalid::new(format!("path point {i}"), value, "m", "finite numbers"));
        }
        Ok(Self { points })
    }

    /// The points, map frame, m.
    pub fn points(&self) -> &[Vector2] {
        &self.points
    }

    /// The sum of the pieces' lengths, m.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
    }
}

/// Indices of the points that preserve the shape of a polyline best \[Douglas73\], in order: its ends, then repeatedly the point farthest from
/// the line between its selected neighbours, until `max_points` are selected, or every other point is at most `tolerance` m off. Always the
/// ends.
#[must_use]
pub fn shape_points(points: &[Vector2], max_points: usize, tolerance: f64) -> Vec<usize> {
    let mut kept: Vec<usize> = [0, points.len().saturating_sub(1)].into_iter().take(points.len()).collect();
    kept.dedup();
    while kept.len() < max_points {
        let farthest = kept.windows(2).filter_map(|ends| farthest(points, ends[0], ends[1]));
        let farthest = farthest.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(off, _)| *off > tolerance);
        let Some((_, index)) = farthest else { break };
        kept.insert(kept.partition_point(|k| *k < index), index);
    }
    kept
}

/// The point between two of a polyline that is farthest from the line between them: its distance \[m\] and its index.
fn farthest(points: &[Vector2], from: usize, to: usize) -> Option<(f64, usize)> {
    let (a, chord) = (points[from], points[to] - points[from]);
    let offset = |index: usize| {
        let beside = points[index] - a;
        let along = (beside.dot(&chord) / chord.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        ((beside - chord * along).norm(), index)
    };
    (from + 1..to).map(offset).max_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polyline_keeps_its_ends_and_corners() {
        let straight = (0..50).map(|i| Vector2::new(0.1 * f64::from(i), 0.0));
        let up = (0..30).map(|i| Vector2::new(4.9, 0.1 * f64::from(i)));
        let line: Vec<Vector2> = straight.chain(up).collect();
        assert_eq!(shape_points(&line, 3, -1.0), [0, 50, 79]);
        assert_eq!(shape_points(&line, 2, -1.0), [0, 79]);
        assert_eq!(shape_points(&line, 80, 0.01), [0, 50, 79], "no other point is off the line");
        assert_eq!(shape_points(&line, 15, -1.0).len(), 15);
        assert!(shape_points(&[], 15, 0.0).is_empty());
        assert_eq!(shape_points(&line[..1], 15, 0.0), [0]);
        let ring =
            [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0), (0.0, 0.0)].map(|(x, y)| Vector2::new(x, y));
        assert_eq!(shape_points(&ring, 9, 0.1), [0, 1, 2, 3, 4]);
    }

    #[test]
    fn length_adds_up_and_nan_is_refused() {
        let path = Path::new(vec![Vector2::zeros(), Vector2::new(3.0, 4.0), Vector2::new(3.0, 5.0)]).unwrap();
        assert_eq!(path.length(), 6.0);
        assert!(Path::new(vec![Vector2::new(f64::NAN, 0.0)]).is_err());
        assert!(Path::new(vec![]).is_err());
    }
}

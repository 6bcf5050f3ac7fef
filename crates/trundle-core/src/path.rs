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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn length_adds_up_and_nan_is_refused() {
        let path = Path::new(vec![Vector2::zeros(), Vector2::new(3.0, 4.0), Vector2::new(3.0, 5.0)]).unwrap();
        assert_eq!(path.length(), 6.0);
        assert!(Path::new(vec![Vector2::new(f64::NAN, 0.0)]).is_err());
        assert!(Path::new(vec![]).is_err());
    }
}

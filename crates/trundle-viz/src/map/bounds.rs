//! Upright rectangles of the map frame.

use trundle_core::Vector2;

/// Largest coordinate that is drawn, m: a larger one is an error of the data. Source: ours.
const MAX_COORDINATE_M: f64 = 1e9;

/// An upright rectangle of the map frame, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    pub min: Vector2,
    pub max: Vector2,
}

impl Bounds {
    /// The smallest rectangle around all points with plausible coordinates. `None` without such a point.
    pub(crate) fn around(points: impl IntoIterator<Item = Vector2>) -> Option<Self> {
        let sensible = |p: &Vector2| p.x.abs() < MAX_COORDINATE_M && p.y.abs() < MAX_COORDINATE_M;
        points.into_iter().filter(sensible).fold(None, |bounds: Option<Self>, p| {
            let b = bounds.unwrap_or(Self { min: p, max: p });
            Some(Self { min: b.min.inf(&p), max: b.max.sup(&p) })
        })
    }

    /// A square around a point. `None` if the point is not finite or the square has no extent.
    pub(crate) fn square(center: Vector2, half_side: f64) -> Option<Self> {
        let half = Vector2::new(half_side, half_side);
        let bounds = Self::around([center - half, center + half])?;
        (half_side > 0.0).then_some(bounds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nonsense_does_not_widen() {
        let p = Vector2::new;
        let bounds = Bounds::around([p(f64::NAN, 0.0), p(1.0, 2.0), p(-1.0, 3.0), p(1e30, 0.0)]).unwrap();
        assert_eq!(bounds, Bounds { min: p(-1.0, 2.0), max: p(1.0, 3.0) });
        assert_eq!(Bounds::around([p(f64::NAN, 0.0)]), None);
        assert_eq!(Bounds::square(p(0.0, 0.0), f64::NAN), None);
        assert_eq!(Bounds::square(p(0.0, 0.0), -1.0), None);
    }
}

//! Thinning and spread of scan points, shared by the two scan matchers.

use nalgebra::Matrix3;
use trundle_core::Vector2;

/// Thins points in the order of the beams: a point within `spacing` of the last selected one is dropped, which gives near and far walls the
/// same weight. Yields the indices of the selected points.
pub(crate) fn thinned(points: impl Iterator<Item = Vector2>, spacing: f64) -> impl Iterator<Item = usize> {
    let mut kept: Option<Vector2> = None;
    points.enumerate().filter_map(move |(k, point)| {
        let near = kept.is_some_and(|kept| (kept - point).norm() < spacing);
        if !near {
            kept = Some(point);
        }
        (!near).then_some(k)
    })
}

/// Centroid of points and their root mean square distance from the centroid.
///
/// A turn by a / `lever` rad moves the points by a on average. In these units shifts and turns are comparable (\[Zhang16\]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PointSpread {
    pub(crate) centroid: Vector2,
    /// Root mean square distance from the centroid, in the unit of the points.
    pub(crate) lever: f64,
}

impl Default for PointSpread {
    fn default() -> Self {
        Self { centroid: Vector2::zeros(), lever: 0.0 }
    }
}

impl PointSpread {
    /// Spread of points; `min_lever` bounds the lever from below.
    pub(crate) fn new(points: impl ExactSizeIterator<Item = Vector2> + Clone, min_lever: f64) -> Self {
        let count = points.len().max(1) as f64;
        let centroid = points.clone().fold(Vector2::zeros(), |sum, point| sum + point) / count;
        let square = |point: Vector2| {
            let off = point - centroid;
            off.x * off.x + off.y * off.y
        };
        let lever = (points.map(square).sum::<f64>() / count).sqrt().max(min_lever);
        Self { centroid, lever }
    }

    /// Displacement of the pose for a displacement y of the centroid, turns in units of length: x = B y. `centroid` is the vector from
    /// the base to the centroid in the axes of the displacement.
    pub(crate) fn pose_from_centroid(&self, centroid: Vector2) -> Matrix3<f64> {
        let (lever, c) = (self.lever, centroid);
        Matrix3::new(1.0, 0.0, c.y / lever, 0.0, 1.0, -c.x / lever, 0.0, 0.0, 1.0 / lever)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;
    use trundle_core::Pose2;

    fn any_points() -> impl Strategy<Value = Vec<Vector2>> {
        prop::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64).prop_map(|(x, y)| Vector2::new(x, y)), 1..40)
    }

    proptest! {
        #[test]
        fn kept_points_are_apart_and_thinning_twice_changes_nothing(points in any_points(), spacing in 0.0..2.0) {
            let once: Vec<Vector2> = thinned(points.iter().copied(), spacing).map(|k| points[k]).collect();
            prop_assert_eq!(once[0], points[0]);
            prop_assert!(once.windows(2).all(|pair| (pair[0] - pair[1]).norm() >= spacing));
            prop_assert!(thinned(once.iter().copied(), spacing).eq(0..once.len()));
            prop_assert_eq!(thinned(points.iter().copied(), 0.0).count(), points.len());
        }

        #[test]
        fn the_spread_moves_and_turns_with_the_points(
            points in any_points(), x in -3.0..3.0, y in -3.0..3.0, theta in -3.0..3.0,
        ) {
            let pose = Pose2::new(x, y, theta);
            let spread = PointSpread::new(points.iter().copied(), 0.1);
            let moved = PointSpread::new(points.iter().map(|p| pose.transform(*p)), 0.1);
            prop_assert!((moved.centroid - pose.transform(spread.centroid)).norm() < 1e-9);
            prop_assert!((moved.lever - spread.lever).abs() < 1e-9);
        }

        #[test]
        fn a_turn_in_units_of_length_moves_the_points_by_that_length_on_average(points in any_points()) {
            prop_assume!(points.len() > 3);
            let spread = PointSpread::new(points.iter().copied(), 0.0);
            let x = spread.pose_from_centroid(spread.centroid) * Vector3::new(0.0, 0.0, 1e-4);
            let pose = Pose2::exp(x);
            let squares = points.iter().map(|p| (pose.transform(*p) - p).norm_squared()).sum::<f64>();
            let rms = (squares / points.len() as f64).sqrt();
            prop_assert!((rms / 1e-4 - 1.0).abs() < 1e-3, "{rms}");
        }
    }

    #[test]
    fn one_point_has_the_minimum_lever() {
        let spread = PointSpread::new([Vector2::new(2.0, 1.0)].into_iter(), 0.1);
        assert_eq!((spread.centroid, spread.lever), (Vector2::new(2.0, 1.0), 0.1));
    }
}

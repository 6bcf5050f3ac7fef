//! The margin that covers the uncertainty of a pose.

use nalgebra::Matrix3;
use trundle_core::{Footprint, Hypotenuse};

/// The margin from obstacles, m, with which a pose of this covariance (x m, y m, heading rad, right perturbation) has no contact within
/// this many standard deviations.
///
/// A point at distance r from the axle has the error of the position plus r times the error of the heading. With the largest standard
/// deviation of the position in any direction and the largest distance of a footprint's point it is `sigmas * (sqrt(largest eigenvalue of
/// the position's part) + r_max * sqrt(heading's variance))`. This is an upper bound for any correlation. An invalid covariance (negative
/// or not finite on its diagonal) gives 0.
pub fn margin_of(covariance: &Matrix3<f64>, footprint: &Footprint, sigmas: f64) -> f64 {
    let (xx, yy) = (covariance[(0, 0)], covariance[(1, 1)]);
    let xy = (covariance[(0, 1)] + covariance[(1, 0)]) / 2.0;
    let greatest = (xx + yy) / 2.0 + ((xx - yy) / 2.0).hypotenuse(xy);
    let margin = sigmas * (greatest.sqrt() + footprint.circumscribed_radius() * covariance[(2, 2)].sqrt());
    if margin.is_finite() { margin } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::{Pose2, Vector2};

    #[test]
    fn the_margin_is_the_stated_sum() {
        let covariance = Matrix3::from_diagonal(&nalgebra::Vector3::new(4e-6, 1e-6, 1e-6));
        let margin = margin_of(&covariance, &Footprint::Disc { radius: 0.5 }, 3.0);
        assert!((margin - 3.0 * (0.002 + 0.5 * 0.001)).abs() < 1e-12);
        assert_eq!(margin_of(&Matrix3::from_diagonal_element(f64::NAN), &Footprint::KOBUKI, 3.0), 0.0);
    }

    proptest! {
        /// No error within three standard deviations moves a corner by more than the margin.
        #[test]
        fn no_error_within_the_sigmas_moves_a_corner_farther(
            a in -0.01..0.01_f64, b in -0.01..0.01_f64, c in -0.01..0.01_f64, t in 0.0..0.02_f64, bearing in 0.0..6.3_f64,
        ) {
            // P = L L^T; the error on the ellipse of three standard deviations in direction `bearing`.
            let l = Matrix3::new(a, 0.0, 0.0, b, c, 0.0, 0.0, 0.0, t);
            let corners = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)].map(|(x, y)| Vector2::new(x, y));
            let margin = margin_of(&(l * l.transpose()), &Footprint::Polygon { corners: corners.to_vec() }, 3.0);
            let error = l * nalgebra::Vector3::new(bearing.cos(), bearing.sin(), 0.0) * 3.0;
            let moved = Pose2::new(error.x, error.y, 3.0 * t);
            for corner in corners {
                prop_assert!((moved.transform(corner) - corner).norm() <= margin + 1e-9);
            }
        }
    }
}

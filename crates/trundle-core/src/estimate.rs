//! The pose estimate that planning and control use: stamp, pose, twist and covariance.

use crate::{Hypotenuse, Pose2, Stamp, Twist2};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// The one pose estimate that planning and control use.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseEstimate {
    /// Time of the estimate.
    pub stamp: Stamp,
    /// `map_from_base`.
    pub pose: Pose2,
    /// The base's twist.
    pub twist: Twist2,
    /// Covariance of `pose` as a right perturbation: x m, y m, theta rad.
    pub covariance: Matrix3<f64>,
}

/// Radius of the ellipse that holds 95 % of a normal distribution in two dimensions, in standard deviations. Source: chi-square, 2 degrees of
/// freedom.
const ELLIPSE_95_SIGMAS: f64 = 2.447_746_8;
/// Half of the interval that holds 95 % of a normal distribution, in standard deviations. Source: chi-square, 1 degree of freedom.
const INTERVAL_95_SIGMAS: f64 = 1.959_964;

impl PoseEstimate {
    /// Standard deviation of the position along its most uncertain axis, m.
    pub fn position_sigma(&self) -> f64 {
        let block = self.covariance.fixed_view::<2, 2>(0, 0);
        let (mean, half) = ((block[(0, 0)] + block[(1, 1)]) / 2.0, (block[(0, 0)] - block[(1, 1)]) / 2.0);
        (mean + half.hypotenuse(block[(0, 1)])).max(0.0).sqrt()
    }

    /// Standard deviation of the heading, rad.
    pub fn heading_sigma(&self) -> f64 {
        self.covariance[(2, 2)].max(0.0).sqrt()
    }

    /// The errors that the pose keeps with a probability of 95 % each.
    pub fn bound_95(&self) -> PoseBound {
        PoseBound {
            distance: ELLIPSE_95_SIGMAS * self.position_sigma(),
            heading: INTERVAL_95_SIGMAS * self.heading_sigma(),
        }
    }
}

/// Bounds of the error of an estimated pose.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PoseBound {
    /// Distance of the true position, m: the longer half axis of the ellipse.
    pub distance: f64,
    /// Error of the heading, rad.
    pub heading: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn at(covariance: Matrix3<f64>) -> PoseEstimate {
        PoseEstimate { stamp: Stamp::default(), pose: Pose2::IDENTITY, twist: Twist2::ZERO, covariance }
    }

    #[test]
    fn the_bound_is_that_of_the_longest_axis() {
        let mut covariance = Matrix3::from_diagonal(&Vector3::new(0.01, 0.04, 0.25));
        assert!((at(covariance).position_sigma() - 0.2).abs() < 1e-12);
        assert!((at(covariance).bound_95().distance - 0.4896).abs() < 1e-4);
        assert!((at(covariance).bound_95().heading - 0.98).abs() < 1e-3);
        // Half a right angle between the axes and those of the ellipse.
        (covariance[(0, 0)], covariance[(0, 1)], covariance[(1, 0)]) = (0.04, 0.03, 0.03);
        assert!((at(covariance).position_sigma() - 0.07_f64.sqrt()).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn the_larger_deviation_of_a_position_does_not_depend_on_the_frame(
            long in 0.01..2.0_f64, part in 0.0..1.0_f64, turn in -3.1..3.1_f64,
        ) {
            let axes = Matrix3::from_diagonal(&Vector3::new(long * long, (part * long).powi(2), 9.0));
            let turned = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), turn).into_inner();
            prop_assert!((at(turned * axes * turned.transpose()).position_sigma() - long).abs() < 1e-6);
        }
    }
}

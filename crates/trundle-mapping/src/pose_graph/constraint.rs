//! Measured relative pose between two poses of the graph.

use nalgebra::{Matrix3, Vector3};
use trundle_core::{Pose2, wrap_angle};

/// A measured relation of two poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Constraint {
    /// Number of the first pose.
    pub(crate) from: u32,
    /// Number of the second pose.
    pub(crate) to: u32,
    /// Pose of the second in the frame of the first, m and rad.
    pub(crate) from_to: Pose2,
    /// Covariance as a right perturbation: m, m, rad.
    pub(crate) covariance: Matrix3<f64>,
}

impl Constraint {
    /// Numbers of the two poses.
    pub(crate) fn poses(&self) -> (usize, usize) {
        (self.from as usize, self.to as usize)
    }

    /// Difference of the poses from the measurement, in the measured second pose's frame: m, m, rad.
    pub(crate) fn residual(&self, from: Pose2, to: Pose2) -> Vector3<f64> {
        let off = self.from_to.inverse() * (from.inverse() * to);
        Vector3::new(off.x, off.y, wrap_angle(off.theta))
    }

    /// Inverse covariance.
    pub(crate) fn information(&self) -> Matrix3<f64> {
        self.covariance.try_inverse().expect("invariant: constraints have positive covariances")
    }

    /// Derivatives of the residual by right perturbations of the two poses.
    pub(crate) fn jacobians(&self, from: Pose2, to: Pose2) -> (Matrix3<f64>, Matrix3<f64>) {
        let between = from.inverse() * to;
        let (s, c) = self.from_to.theta.sin_cos();
        let back = |x: f64, y: f64| (c * x + s * y, c * y - s * x);
        let (ax, ay) = back(between.y, -between.x);
        let by_from = Matrix3::new(-c, -s, ax, s, -c, ay, 0.0, 0.0, -1.0);
        let (s, c) = (between.theta - self.from_to.theta).sin_cos();
        (by_from, Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jacobians_are_the_differences() {
        let (from, to) = (Pose2::new(1.0, -2.0, 0.7), Pose2::new(2.5, 0.3, -1.1));
        let constraint = Constraint {
            from: 0,
            to: 1,
            from_to: Pose2::new(2.0, 1.0, -1.5),
            covariance: Matrix3::identity(),
        };
        let (by_from, by_to) = constraint.jacobians(from, to);
        for k in 0..3 {
            let mut step = Vector3::zeros();
            step[k] = 1e-6;
            let moved = |pose: Pose2| pose * Pose2::new(step.x, step.y, step.z);
            let before = constraint.residual(from, to);
            let numeric_from = (constraint.residual(moved(from), to) - before) / 1e-6;
            let numeric_to = (constraint.residual(from, moved(to)) - before) / 1e-6;
            assert!((numeric_from - by_from.column(k)).norm() < 1e-4);
            assert!((numeric_to - by_to.column(k)).norm() < 1e-4);
        }
    }
}

//! The residual of a point against an observation.

use nalgebra::{Matrix2x3, Matrix3, Matrix3x6, RowVector3};
use trundle_core::{PinholeCamera, Pose3, Vector2, Vector3};

/// A point known in camera frame a, and its measurement in image b.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Observation {
    /// Camera frame a, m.
    pub point: Vector3,
    /// Rectified pixel in image b.
    pub pixel: Vector2,
    /// Inverse of the pixel's standard deviation, 1/px.
    pub per_px: f64,
    /// Depth in image b, m.
    pub depth: f64,
    /// Inverse of the depth's standard deviation, 1/m; 0 for an unknown depth.
    pub per_m: f64,
    /// Squared residual beyond which Huber's loss is linear, and an inlier ends.
    pub bound: f64,
}

/// Squared residual of a point behind the camera: 1e8, finite and larger than any in front of the camera. Source: ours.
const CHI2_BEHIND_CAMERA: f64 = 1e8;

impl Observation {
    /// Column, row and depth: measured less predicted, each in its standard deviations. `None` behind the camera.
    pub fn residual(&self, camera: &PinholeCamera, p_b: Vector3) -> Option<Vector3> {
        let pixel = (self.pixel - camera.project(p_b)?) * self.per_px;
        Some(Vector3::new(pixel.x, pixel.y, (self.depth - p_b.z) * self.per_m))
    }

    /// The squared length of the residual.
    pub fn chi2(&self, camera: &PinholeCamera, p_b: Vector3) -> f64 {
        self.residual(camera, p_b).map_or(CHI2_BEHIND_CAMERA, |r| r.norm_squared())
    }

    /// Derivative of the residual by the right perturbation of `b_from_a`, translation first.
    pub fn jacobian(&self, camera: &PinholeCamera, rotation: &Matrix3<f64>, p_b: Vector3) -> Matrix3x6<f64> {
        let z = 1.0 / p_b.z;
        let projection = Matrix2x3::new(
            camera.fx() * z,
            0.0,
            -camera.fx() * p_b.x * z * z,
            0.0,
            camera.fy() * z,
            -camera.fy() * p_b.y * z * z,
        );
        let mut by_point = Matrix3::zeros();
        by_point.fixed_rows_mut::<2>(0).copy_from(&(projection * -self.per_px));
        by_point.set_row(2, &RowVector3::new(0.0, 0.0, -self.per_m));
        let by_translation = by_point * rotation;
        let mut jacobian = Matrix3x6::zeros();
        jacobian.fixed_columns_mut::<3>(0).copy_from(&by_translation);
        jacobian.fixed_columns_mut::<3>(3).copy_from(&(by_translation * -self.point.cross_matrix()));
        jacobian
    }
}

/// A pose with its rotation as a matrix, for the transformation of many points.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mover {
    pub rotation: Matrix3<f64>,
    translation: Vector3,
}

impl Mover {
    pub fn transform(&self, point: Vector3) -> Vector3 {
        self.rotation * point + self.translation
    }
}

impl From<Pose3> for Mover {
    fn from(pose: Pose3) -> Self {
        Self { rotation: pose.rotation_matrix(), translation: pose.translation }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;

    #[test]
    fn the_jacobian_is_the_derivative() {
        let camera = PinholeCamera::kinect_v2();
        let observation = Observation {
            point: Vector3::new(0.4, -0.3, 2.0),
            pixel: Vector2::new(300.0, 200.0),
            per_px: 0.7,
            depth: 2.2,
            per_m: 40.0,
            bound: 7.8,
        };
        let pose = Pose3::exp(Vector6::new(0.1, -0.2, 0.3, 0.2, -0.1, 0.3));
        let residual =
            |pose: Pose3| observation.residual(&camera, pose.transform(observation.point)).unwrap();
        let jacobian =
            observation.jacobian(&camera, &pose.rotation_matrix(), pose.transform(observation.point));
        for axis in 0..6 {
            let mut step = Vector6::zeros();
            step[axis] = 1e-6;
            let slope = (residual(pose * Pose3::exp(step)) - residual(pose * Pose3::exp(-step))) / 2e-6;
            assert!((slope - jacobian.column(axis)).norm() < 1e-5, "axis {axis}");
        }
    }
}

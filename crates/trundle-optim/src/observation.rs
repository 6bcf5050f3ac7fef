//! Measurement of a point by an RGB-D camera, and its residual.

use crate::Huber;
use nalgebra::{Matrix3, Matrix3x6};
use trundle_core::{PinholeCamera, Vector2, Vector3};

/// The 95th percentile of the chi-square distribution with 2 degrees of freedom. Source: the chi-square distribution.
pub const CHI2_95_2: f64 = 5.991;
/// The 95th percentile of the chi-square distribution with 3 degrees of freedom. Source: the chi-square distribution.
pub const CHI2_95_3: f64 = 7.815;
/// The 95th percentile of the chi-square distribution with 6 degrees of freedom: of a whole pose. Source: the chi-square distribution.
pub const CHI2_95_6: f64 = 12.592;
/// The 99.9th percentile of the chi-square distribution with 6 degrees of freedom. Source: the chi-square distribution.
pub(crate) const CHI2_999_6: f64 = 22.458;
/// Smallest depth of a point along the optical axis that has a projection: 0.02 m. A nearer point counts as behind the camera.
/// Source: ours.
pub(crate) const MIN_PROJECTION_DEPTH_M: f64 = 0.02;

/// A measured inverse depth. Sensors that measure a disparity (Kinect v1, stereo) have the same `sigma` at every range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InverseDepth {
    /// 1 / (depth along the optical axis), 1/m.
    pub value: f64,
    /// Standard deviation of the inverse depth, 1/m.
    pub sigma: f64,
}

/// Measurement of one point in one image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointObservation {
    /// Position of the observation, rectified px.
    pub pixel: Vector2,
    /// Standard deviation of either pixel coordinate, px.
    pub pixel_sigma: f64,
    /// Inverse depth along the optical axis; `None` without a measurement.
    pub depth: Option<InverseDepth>,
}

/// A residual in standard deviations, and its Jacobian by the point in the camera frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Linearized {
    /// (column, row, inverse depth), predicted minus measured, over sigma. The third is 0 without a depth.
    pub residual: Vector3,
    /// Derivative of `residual` by the camera-frame point, 1/m.
    pub by_point: Matrix3<f64>,
}

impl PointObservation {
    /// The 95 % bound of the squared residual: 3 degrees of freedom with a depth, else 2.
    pub fn chi2_bound(&self) -> f64 {
        if self.depth.is_some() { CHI2_95_3 } else { CHI2_95_2 }
    }

    /// The Huber loss that turns linear at the 95 % bound.
    pub fn huber(&self) -> Huber {
        Huber::beyond(self.chi2_bound())
    }

    /// The residual in standard deviations for a point at `p_camera` (m); `None` behind or in the lens.
    pub fn residual(&self, camera: &PinholeCamera, p_camera: Vector3) -> Option<Vector3> {
        if p_camera.z < MIN_PROJECTION_DEPTH_M {
            return None;
        }
        let inverse = 1.0 / p_camera.z;
        let u = camera.fx() * p_camera.x * inverse + camera.cx() - self.pixel.x;
        let v = camera.fy() * p_camera.y * inverse + camera.cy() - self.pixel.y;
        let depth = self.depth.map_or(0.0, |d| (inverse - d.value) / d.sigma);
        Some(Vector3::new(u / self.pixel_sigma, v / self.pixel_sigma, depth))
    }

    /// The squared residual for a point at `p_camera` (m); infinite behind the lens.
    pub fn chi2(&self, camera: &PinholeCamera, p_camera: Vector3) -> f64 {
        self.residual(camera, p_camera).map_or(f64::INFINITY, |r| r.norm_squared())
    }

    /// Residual and Jacobian for a point at `p_camera` (m); `None` behind or in the lens.
    pub fn linearize(&self, camera: &PinholeCamera, p_camera: Vector3) -> Option<Linearized> {
        let residual = self.residual(camera, p_camera)?;
        let inverse = 1.0 / p_camera.z;
        let (fx, fy) = (camera.fx() * inverse / self.pixel_sigma, camera.fy() * inverse / self.pixel_sigma);
        let depth = self.depth.map_or(0.0, |d| -inverse * inverse / d.sigma);
        #[rustfmt::skip]
        let by_point = Matrix3::new(
            fx, 0.0, -fx * p_camera.x * inverse,
            0.0, fy, -fy * p_camera.y * inverse,
            0.0, 0.0, depth,
        );
        Some(Linearized { residual, by_point })
    }
}

/// The derivative of `camera_from_world * p_world` by a right perturbation (rho, phi) of `world_from_camera`:
/// exp(-xi) p = p - rho + p x phi.
pub(crate) fn camera_point_by_pose(p_camera: Vector3) -> Matrix3x6<f64> {
    let mut jacobian = Matrix3x6::zeros();
    jacobian.fixed_view_mut::<3, 3>(0, 0).copy_from(&-Matrix3::identity());
    jacobian.fixed_view_mut::<3, 3>(0, 3).copy_from(&p_camera.cross_matrix());
    jacobian
}

/// Cost of a point behind the camera: 1e3. The value rejects a step without dominating the sum. Source: ours.
pub(crate) const COST_BEHIND_CAMERA: f64 = 1e3;

/// The robust loss of an observation of a point at `p_camera`.
pub(crate) fn robust_cost(camera: &PinholeCamera, seen: &PointObservation, p_camera: Vector3) -> f64 {
    seen.residual(camera, p_camera)
        .map_or(COST_BEHIND_CAMERA, |r| seen.huber().cost(r.norm_squared()).min(COST_BEHIND_CAMERA))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;
    use proptest::prelude::*;
    use trundle_core::{Distortion, Pose3};

    fn camera() -> PinholeCamera {
        PinholeCamera::new((640, 480), (517.3, 516.5), (318.6, 255.3), Distortion::default()).unwrap()
    }

    fn seen(depth: bool) -> PointObservation {
        let depth = depth.then_some(InverseDepth { value: 0.4, sigma: 0.003 });
        PointObservation { pixel: Vector2::new(300.0, 200.0), pixel_sigma: 1.2, depth }
    }

    proptest! {
        #[test]
        fn jacobians_agree_with_differences(
            xi in prop::array::uniform6(-0.5..0.5), p in prop::array::uniform3(-1.0..1.0), depth: bool,
        ) {
            let world_from_camera = Pose3::exp(Vector6::from(xi));
            let p_world = world_from_camera.transform(Vector3::new(p[0], p[1], p[2] + 2.5));
            let (camera, seen) = (camera(), seen(depth));
            let p_camera = world_from_camera.inverse().transform(p_world);
            let here = seen.linearize(&camera, p_camera).unwrap();
            let by_pose = here.by_point * camera_point_by_pose(p_camera);
            let by_world = here.by_point * world_from_camera.inverse().rotation_matrix();
            let at = |pose: Pose3, p: Vector3| seen.residual(&camera, pose.inverse().transform(p)).unwrap();
            const H: f64 = 1e-6;
            for i in 0..6 {
                let step = |h| Pose3::exp(Vector6::ith(i, h));
                let numeric = (at(world_from_camera * step(H), p_world)
                    - at(world_from_camera * step(-H), p_world)) / (2.0 * H);
                prop_assert!((numeric - by_pose.column(i)).norm() < 1e-4 * (1.0 + numeric.norm()));
            }
            for i in 0..3 {
                let step = |h| p_world + Vector3::ith(i, h);
                let numeric =
                    (at(world_from_camera, step(H)) - at(world_from_camera, step(-H))) / (2.0 * H);
                prop_assert!((numeric - by_world.column(i)).norm() < 1e-4 * (1.0 + numeric.norm()));
            }
        }
    }

    #[test]
    fn points_behind_the_camera_cost_but_do_not_break() {
        let behind = Vector3::new(0.1, 0.1, -1.0);
        assert!(seen(true).linearize(&camera(), behind).is_none());
        assert_eq!(seen(true).chi2(&camera(), behind), f64::INFINITY);
        assert_eq!(robust_cost(&camera(), &seen(true), behind), COST_BEHIND_CAMERA);
    }
}

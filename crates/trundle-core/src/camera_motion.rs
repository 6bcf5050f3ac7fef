//! The camera's motion between two images as measured by wheels and gyro, with its covariance.

use crate::{Hypotenuse, Pose2, Pose3};
use nalgebra::{Matrix3, Matrix6, Vector6};

/// Standard deviation of the floor's height, m per sqrt(m) of path. Source: \[DIN18202, table 3\], 1 cm over 4 m.
const FLOOR_HEIGHT_NOISE: f64 = 0.005;
/// Standard deviation of the floor's tilt, rad per sqrt(m) of path. Source: \[DIN18202, table 3\], 4 mm over 1 m.
const FLOOR_TILT_NOISE: f64 = 0.004;
/// Path of a wheel while the base turns by 1 rad, m: half of the Kobuki's wheelbase. Source: the Kobuki's protocol, "Base
/// Control", b = 230 mm.
const HALF_WHEELBASE_M: f64 = 0.115;
/// Standard deviation of the camera's position against the base besides the odometry's own error \[m\]: the sway of a camera on a short
/// mast. Without it the covariance of a robot at rest is singular; a larger value lets a robot that turns on the spot drift by
/// centimetres. Source: docs/experiments/slam-odometry.md.
const MAST_SWAY_SIGMA_M: f64 = 1e-4;
/// Standard deviation of the camera's rotation against the base besides the odometry's own error \[rad\]. Source: as [`MAST_SWAY_SIGMA_M`].
const MAST_SWAY_SIGMA_RAD: f64 = 5e-4;
/// Rows of x, y and yaw.
const IN_PLANE: [usize; 3] = [0, 1, 5];

/// Motion of a camera between two images, measured by other sensors such as wheels and gyro.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraMotion {
    /// `previous_camera_from_camera`.
    pub motion: Pose3,
    /// Covariance of `motion` as a right perturbation (m, m, m, rad, rad, rad); `None` if unknown.
    pub covariance: Option<Matrix6<f64>>,
}

impl CameraMotion {
    /// Motion of the camera at `base_from_camera` for a motion of the base: camera_from_base * previous_base_from_base * base_from_camera.
    /// `planar` is the covariance of the base's motion as a right perturbation (x m, y m, theta rad). Outside the floor's plane the
    /// covariance is that of uneven floors.
    pub fn of_base((base_motion, planar): (Pose2, Matrix3<f64>), base_from_camera: Pose3) -> Self {
        let camera_from_base = base_from_camera.inverse();
        let motion = camera_from_base * Pose3::from_pose2(base_motion) * base_from_camera;
        let to_camera = camera_from_base.adjoint();
        let covariance = to_camera * in_space(&base_motion, &planar) * to_camera.transpose();
        Self { motion, covariance: Some((covariance + covariance.transpose()) * 0.5) }
    }

    /// Covariance of the camera's sway on its mast as a right perturbation (m, m, m, rad, rad, rad), for a motion of any length.
    pub fn mast_sway() -> Matrix6<f64> {
        let (shift, turn) = (MAST_SWAY_SIGMA_M.powi(2), MAST_SWAY_SIGMA_RAD.powi(2));
        Matrix6::from_diagonal(&Vector6::new(shift, shift, shift, turn, turn, turn))
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.motion.is_finite() && self.covariance.is_none_or(|c| c.iter().all(|v| v.is_finite()))
    }
}

/// A motion with unknown covariance.
impl From<Pose3> for CameraMotion {
    fn from(motion: Pose3) -> Self {
        Self { motion, covariance: None }
    }
}

/// Covariance of the base's motion in space: the given one in the plane, that of the floor outside it.
fn in_space(motion: &Pose2, planar: &Matrix3<f64>) -> Matrix6<f64> {
    let path = motion.x.hypotenuse(motion.y) + HALF_WHEELBASE_M * motion.theta.abs();
    let (up, tilt) = (FLOOR_HEIGHT_NOISE.powi(2) * path, FLOOR_TILT_NOISE.powi(2) * path);
    let mut covariance = Matrix6::from_diagonal(&Vector6::new(0.0, 0.0, up, tilt, tilt, 0.0));
    for (i, row) in IN_PLANE.into_iter().enumerate() {
        for (j, column) in IN_PLANE.into_iter().enumerate() {
            covariance[(row, column)] = planar[(i, j)];
        }
    }
    covariance
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector3;
    use proptest::prelude::*;

    fn any_pose2() -> impl Strategy<Value = Pose2> {
        (-5.0..5.0, -5.0..5.0, -3.0..3.0).prop_map(|(x, y, t)| Pose2::new(x, y, t))
    }

    proptest! {
        #[test]
        fn camera_poses_follow_from_it(a in any_pose2(), b in any_pose2(), tilt in -0.5..0.5_f64) {
            let turn = nalgebra::UnitQuaternion::from_euler_angles(-1.6 + tilt, 0.1, -1.5);
            let base_from_camera = Pose3::new(turn, Vector3::new(0.1, -0.02, 0.6));
            let at = |pose: Pose2| Pose3::from_pose2(pose) * base_from_camera;
            let moved = at(a) * CameraMotion::of_base((a.inverse() * b, Matrix3::zeros()), base_from_camera).motion;
            prop_assert!((moved.inverse() * at(b)).log().norm() < 1e-9);
        }
    }

    #[test]
    fn a_turn_on_the_spot_swings_a_camera_that_sits_ahead() {
        let base_from_camera = Pose3::new(Default::default(), Vector3::new(0.2, 0.0, 0.5));
        let turn = Pose2::new(0.0, 0.0, std::f64::consts::FRAC_PI_2);
        let motion = CameraMotion::of_base((turn, Matrix3::zeros()), base_from_camera).motion;
        assert!((motion.translation - Vector3::new(-0.2, 0.2, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn the_uncertainty_of_the_base_is_that_of_the_camera() {
        let turn = nalgebra::UnitQuaternion::from_euler_angles(-1.9, 0.1, -1.5);
        let base_from_camera = Pose3::new(turn, Vector3::new(0.3, -0.2, 0.6));
        let planar = Matrix3::new(4.0, 0.5, 0.1, 0.5, 1.0, 0.2, 0.1, 0.2, 9.0) * 1e-6;
        let given = CameraMotion::of_base((Pose2::new(0.2, 0.0, 0.1), planar), base_from_camera);
        let to_base = base_from_camera.adjoint();
        let back = to_base * given.covariance.unwrap() * to_base.transpose();
        let back = Matrix3::from_fn(|i, j| back[(IN_PLANE[i], IN_PLANE[j])]);
        assert!((back - planar).norm() < 1e-15);
    }
}

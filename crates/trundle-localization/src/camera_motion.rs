use nalgebra::{Matrix3, Matrix6, Vector6};
use trundle_core::{CameraMotion, Pose2, Pose3};

/// How far a floor leads a robot out of its plane: m / sqrt(m) and rad / sqrt(m); 1 cm over 4 m and 4 mm over 1 m \[DIN18202, table 3\].
const UNEVEN: (f64, f64) = (0.005, 0.004);
/// The way of a wheel's rim while the base turns by 1 rad, m: half a wheelbase.
const RIM: f64 = 0.115;

/// What the camera did while the base moved: `previous_camera_from_camera` from `previous_base_from_base` and its covariance, as
/// [`crate::Odometer::since`] gives them.
///
/// The motion prior of visual tracking: camera_from_base * previous_base_from_base * base_from_camera. Out of the floor's plane the
/// camera moves as far as floors are uneven.
pub fn camera_motion((base_motion, planar): (Pose2, Matrix3<f64>), base_from_camera: Pose3) -> CameraMotion {
    let camera_from_base = base_from_camera.inverse();
    let motion = camera_from_base * Pose3::from_pose2(base_motion) * base_from_camera;
    let to_camera = camera_from_base.adjoint();
    let covariance = to_camera * in_space(&base_motion, &planar) * to_camera.transpose();
    CameraMotion { motion, covariance: Some((covariance + covariance.transpose()) * 0.5) }
}

/// Of the base's motion in space: in the plane as given, out of it by the floor.
fn in_space(motion: &Pose2, planar: &Matrix3<f64>) -> Matrix6<f64> {
    let way = motion.x.hypot(motion.y) + RIM * motion.theta.abs();
    let (up, tilt) = (UNEVEN.0.powi(2) * way, UNEVEN.1.powi(2) * way);
    let mut covariance = Matrix6::from_diagonal(&Vector6::new(0.0, 0.0, up, tilt, tilt, 0.0));
    const IN_PLANE: [usize; 3] = [0, 1, 5];
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
    use proptest::prelude::*;
    use trundle_core::Vector3;

    fn any_pose2() -> impl Strategy<Value = Pose2> {
        (-5.0..5.0, -5.0..5.0, -3.0..3.0).prop_map(|(x, y, t)| Pose2::new(x, y, t))
    }

    proptest! {
        #[test]
        fn camera_poses_follow_from_it(a in any_pose2(), b in any_pose2(), tilt in -0.5..0.5_f64) {
            let turn = nalgebra::UnitQuaternion::from_euler_angles(-1.6 + tilt, 0.1, -1.5);
            let base_from_camera = Pose3::new(turn, Vector3::new(0.1, -0.02, 0.6));
            let at = |pose: Pose2| Pose3::from_pose2(pose) * base_from_camera;
            let moved = at(a) * camera_motion((a.inverse() * b, Matrix3::zeros()), base_from_camera).motion;
            prop_assert!((moved.inverse() * at(b)).log().norm() < 1e-9);
        }
    }

    #[test]
    fn a_turn_on_the_spot_swings_a_camera_that_sits_ahead() {
        let base_from_camera = Pose3::new(Default::default(), Vector3::new(0.2, 0.0, 0.5));
        let turn = Pose2::new(0.0, 0.0, std::f64::consts::FRAC_PI_2);
        let motion = camera_motion((turn, Matrix3::zeros()), base_from_camera).motion;
        assert!((motion.translation - Vector3::new(-0.2, 0.2, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn what_the_base_may_be_off_is_what_the_camera_may_be_off() {
        let turn = nalgebra::UnitQuaternion::from_euler_angles(-1.9, 0.1, -1.5);
        let base_from_camera = Pose3::new(turn, Vector3::new(0.3, -0.2, 0.6));
        let planar = Matrix3::new(4.0, 0.5, 0.1, 0.5, 1.0, 0.2, 0.1, 0.2, 9.0) * 1e-6;
        let told = camera_motion((Pose2::new(0.2, 0.0, 0.1), planar), base_from_camera);
        let back = crate::planar_covariance(&told.covariance.unwrap(), &base_from_camera);
        assert!((back - planar).norm() < 1e-15);
    }
}

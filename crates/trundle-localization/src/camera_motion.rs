use trundle_core::{Pose2, Pose3};

/// What the camera did while the base moved: `previous_camera_from_camera` from `previous_base_from_base`.
///
/// The motion prior of visual tracking: camera_from_base * previous_base_from_base * base_from_camera.
pub fn camera_motion(base_motion: Pose2, base_from_camera: Pose3) -> Pose3 {
    base_from_camera.inverse() * Pose3::from_pose2(base_motion) * base_from_camera
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
            let moved = at(a) * camera_motion(a.inverse() * b, base_from_camera);
            prop_assert!((moved.inverse() * at(b)).log().norm() < 1e-9);
        }
    }

    #[test]
    fn a_turn_on_the_spot_swings_a_camera_that_sits_ahead() {
        let base_from_camera = Pose3::new(Default::default(), Vector3::new(0.2, 0.0, 0.5));
        let motion = camera_motion(Pose2::new(0.0, 0.0, std::f64::consts::FRAC_PI_2), base_from_camera);
        assert!((motion.translation - Vector3::new(-0.2, 0.2, 0.0)).norm() < 1e-12);
    }
}

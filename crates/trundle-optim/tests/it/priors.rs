//! Laws of the fusion of a pose with a prior.

use crate::support::{any_pose, gap};
use nalgebra::Matrix6;
use proptest::prelude::*;
use trundle_core::Pose3;
use trundle_optim::PosePrior;

fn prior(world_from_camera: Pose3, sigma: f64) -> PosePrior {
    PosePrior { world_from_camera, covariance: Matrix6::identity() * sigma * sigma }
}

proptest! {
    #[test]
    fn two_equal_poses_fuse_to_the_same_pose(pose in any_pose(1.5), a in 0.001..0.1_f64, b in 0.001..0.1_f64) {
        let (fused, _) = prior(pose, a).fused_with(pose, &(Matrix6::identity() * b * b), 1.0).unwrap();
        prop_assert!(gap(fused, pose) < 1e-9);
    }

    #[test]
    fn the_fused_pose_lies_between_both(pose in any_pose(1.5), off in any_pose(0.01), a in 0.01..0.1_f64, b in 0.01..0.1_f64) {
        let other = pose * off;
        let Some((fused, _)) = prior(pose, a).fused_with(other, &(Matrix6::identity() * b * b), 1.0) else { return Ok(()) };
        let whole = gap(pose, other);
        prop_assert!((gap(pose, fused) + gap(fused, other) - whole).abs() < 1e-3 * whole + 1e-9);
        // The result is nearer to the pose with the smaller covariance.
        prop_assert!((gap(pose, fused) < gap(fused, other)) == (a < b) || (a - b).abs() < 1e-3);
    }

    #[test]
    fn a_common_change_of_frame_moves_the_fused_pose(pose in any_pose(1.0), off in any_pose(0.01), world in any_pose(1.5)) {
        let covariance = Matrix6::identity() * 4e-4;
        let (here, sure) = prior(pose, 0.02).fused_with(pose * off, &covariance, 2.0).unwrap();
        let (there, moved) = prior(world * pose, 0.02).fused_with(world * pose * off, &covariance, 2.0).unwrap();
        prop_assert!(gap(world * here, there) < 1e-9 && (sure - moved).norm() < 1e-9);
    }

    #[test]
    fn a_contradiction_is_refused_from_the_same_distance_in_every_direction(direction in any_pose(1.0)) {
        let unit = direction.log().normalize();
        // The 99.9 % bound of six degrees of freedom is 22.458 squared standard deviations: 4.739.
        let fused = |sigmas: f64| {
            let off = Pose3::exp(unit * sigmas * (2.0 * 0.01_f64.powi(2)).sqrt());
            prior(Pose3::identity(), 0.01).fused_with(off, &(Matrix6::identity() * 1e-4), 1.0)
        };
        prop_assert!(fused(4.7).is_some() && fused(4.8).is_none());
    }

    #[test]
    fn the_result_is_never_called_more_certain_than_the_pose_was(pose in any_pose(1.0), off in any_pose(0.01), a in 0.01..0.1_f64) {
        let covariance = Matrix6::identity() * 4e-4;
        if let Some((_, fused)) = prior(pose, a).fused_with(pose * off, &covariance, 1.0) {
            prop_assert!((fused - covariance).symmetric_eigenvalues().min() > -1e-12);
        }
    }
}

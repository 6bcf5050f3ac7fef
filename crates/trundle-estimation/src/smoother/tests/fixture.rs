//! A short drive for the tests of the parts.

use super::super::config::{SmootherConfig, WindowConfig};
use super::super::fixed_lag::Smoother;
use super::super::measurement::PlanarMeasurement;
use crate::fusion::correction::{VisualPose, VisualQuality};
use crate::odometry::motion_increment::MotionIncrement;
use crate::odometry_config::OdometryConfig;
use nalgebra::{Matrix3, Matrix6, Vector3};
use trundle_core::{DifferentialDrive, Pose2, Pose3, Stamp};

/// A disturbance with a long period, -1 to 1.
pub(super) fn wave(i: i64, phase: f64) -> f64 {
    (i as f64 * 0.77 + phase * 11.0).sin()
}

pub(super) fn increment(i: i64) -> MotionIncrement {
    let rests = (20..40).contains(&i);
    let (distance, turn) = if rests { (0.0, 0.0) } else { (0.006, 0.02 * (i as f64 * 0.03).cos()) };
    MotionIncrement {
        stamp: Stamp::from_nanos(i * 20_000_000),
        dt: 0.02,
        left: distance - 0.115 * turn * 1.01 + 1e-5 * wave(i, 0.1),
        right: distance + 0.115 * turn + 1e-5 * wave(i, 0.2),
        turn_by_gyro: Some(turn + 2e-4 + 5e-5 * wave(i, 0.3)),
        slip: 0.0,
        is_at_rest: rests,
        unobserved: Matrix3::zeros(),
    }
}

/// Drives for `steps` readings of the wheels, with errors of images and scan matches.
pub(super) fn driven(steps: i64) -> Smoother {
    let window = WindowConfig { length: 60.0, keyframe_distance: 0.03, ..WindowConfig::default() };
    let config = SmootherConfig { window, ..SmootherConfig::default() };
    let drive = DifferentialDrive::KOBUKI;
    let mut smoother = Smoother::new(config, OdometryConfig::default(), drive, Pose3::identity()).unwrap();
    let mut truth = Pose2::IDENTITY;
    for i in 1..=steps {
        let step = increment(i);
        let turn = (step.right - step.left) / 0.2305;
        truth = truth * Pose2::exp(Vector3::new((step.left + step.right) / 2.0 * 1.01, 0.0, turn));
        smoother.add_motion(&step);
        if i % 3 == 0 && !(60..90).contains(&i) {
            smoother.add_visual(&visual(i, truth));
        }
        if i % 25 == 0 {
            let off = Vector3::new(0.01 * wave(i, 0.4), 0.01 * wave(i, 0.5), 0.004 * wave(i, 0.6));
            let covariance = Matrix3::from_diagonal_element(1e-5);
            let stamp = step.stamp;
            smoother.add_scan(&PlanarMeasurement { stamp, pose: truth * Pose2::exp(off), covariance });
        }
    }
    smoother
}

fn visual(i: i64, truth: Pose2) -> VisualPose {
    let pose = Pose2::new(
        truth.x + 0.001 * wave(i, 0.7),
        truth.y + 0.001 * wave(i, 0.8),
        truth.theta + 0.0005 * wave(i, 0.9),
    );
    VisualPose {
        stamp: Stamp::from_nanos(i * 20_000_000),
        visual_from_camera: Pose3::from_pose2(pose),
        covariance: Matrix6::zeros(),
        quality: VisualQuality::Ok,
        map: 0,
        recognised: i == 120,
    }
}

//! The camera's motion between two images by the odometry of a sequence.

use crate::sequence_input::SequenceInput;
use trundle_core::{CameraMotion, Pose2, Pose3, Stamp};
use trundle_localization::OdometryConfig;

/// The camera's motion by the odometry of a sequence, where it has one; the camera is mounted as on the sequence's robot.
pub struct OdometryPrior<'a> {
    poses: &'a [(Stamp, Pose2)],
    base_from_camera: Pose3,
    noise: OdometryConfig,
}

impl<'a> OdometryPrior<'a> {
    /// The odometry of `input`.
    pub fn new(input: &'a SequenceInput) -> Self {
        let robot = &input.robot;
        let base_from_camera = robot.mount.base_from_camera();
        Self { poses: input.odometry().unwrap_or(&[]), base_from_camera, noise: robot.odometry.clone() }
    }

    /// `earlier_camera_from_later_camera`; `None` in a gap of the odometry, and where it jumps.
    pub fn motion(&self, earlier: Stamp, later: Stamp) -> Option<CameraMotion> {
        let base_motion = self.at(earlier)?.inverse() * self.at(later)?;
        let farthest = self.noise.max_speed * (later - earlier);
        if base_motion.x.hypot(base_motion.y) > farthest {
            return None;
        }
        let noise = self.noise.by_wheels(&base_motion);
        Some(CameraMotion::of_base((base_motion, noise), self.base_from_camera))
    }

    fn at(&self, stamp: Stamp) -> Option<Pose2> {
        let after = self.poses.partition_point(|(at, _)| *at <= stamp);
        let (t0, a) = self.poses.get(after.checked_sub(1)?)?;
        let (t1, b) = self.poses.get(after).filter(|(t1, _)| *t1 - *t0 <= self.noise.max_gap)?;
        Some(a.interpolate(b, (stamp - *t0) / (*t1 - *t0)))
    }
}

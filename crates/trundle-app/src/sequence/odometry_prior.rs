//! The camera's motion between two images by the odometry of a sequence.

use crate::pose_coverage::why_uncovered;
use crate::sequence_input::SequenceInput;
use trundle_core::{CameraMotion, Hypotenuse, Pose2, Pose3, Stamp};
use trundle_estimation::OdometryConfig;

/// The camera's motion by the odometry of a sequence, if it has one; the camera is mounted as on the sequence's robot.
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

    /// `earlier_camera_from_later_camera`; `None` in a gap and at a jump of the odometry.
    pub fn motion(&self, earlier: Stamp, later: Stamp) -> Option<CameraMotion> {
        let base_motion = self.at(earlier)?.inverse() * self.at(later)?;
        let farthest = self.noise.max_speed * (later - earlier);
        if base_motion.x.hypotenuse(base_motion.y) > farthest {
            return None;
        }
        let noise = self.noise.by_wheels(&base_motion);
        Some(CameraMotion::of_base((base_motion, noise), self.base_from_camera))
    }

    /// The camera in the frame of the odometry at the stamps of `poses`, where the odometry covers them.
    pub fn camera_poses(&self, poses: &[(Stamp, Pose3)]) -> Vec<(Stamp, Pose3)> {
        let camera = |stamp| Some((stamp, Pose3::from_pose2(self.at(stamp)?) * self.base_from_camera));
        poses.iter().filter_map(|(stamp, _)| camera(*stamp)).collect()
    }

    /// The reason why no two of the images have odometry between them; `images` are the stamps of the first and the last image.
    pub fn why_no_motion(&self, images: (Stamp, Stamp)) -> String {
        format!("no motion between images: {}", why_uncovered(self.poses, images, self.noise.max_gap))
    }

    fn at(&self, stamp: Stamp) -> Option<Pose2> {
        let after = self.poses.partition_point(|(at, _)| *at <= stamp);
        let (t0, a) = self.poses.get(after.checked_sub(1)?)?;
        let (t1, b) = self.poses.get(after).filter(|(t1, _)| *t1 - *t0 <= self.noise.max_gap)?;
        Some(a.interpolate(b, (stamp - *t0) / (*t1 - *t0)))
    }
}

//! The camera's motion between two images by the odometry of a sequence.

use crate::sequence_input::SequenceInput;
use trundle_core::{CameraMotion, Pose2, Pose3, Stamp};
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
        if base_motion.x.hypot(base_motion.y) > farthest {
            return None;
        }
        let noise = self.noise.by_wheels(&base_motion);
        Some(CameraMotion::of_base((base_motion, noise), self.base_from_camera))
    }

    /// The reason why no two of the images have odometry between them; `first` and `last` are the stamps of the first and the last image.
    pub fn why_no_motion(&self, (first, last): (Stamp, Stamp)) -> String {
        let Some(((from, _), (to, _))) = self.poses.first().zip(self.poses.last()) else {
            return "no motion between images: it holds no pose".to_owned();
        };
        let ranges = format!("the images are of {first} s to {last} s, the odometry of {from} s to {to} s");
        if last < *from || *to < first {
            return format!("no motion between images: {ranges}, expected one clock for both");
        }
        let gap = self.noise.max_gap;
        format!("no motion between images: {ranges}, expected poses at most {gap} s apart, without jumps")
    }

    fn at(&self, stamp: Stamp) -> Option<Pose2> {
        let after = self.poses.partition_point(|(at, _)| *at <= stamp);
        let (t0, a) = self.poses.get(after.checked_sub(1)?)?;
        let (t1, b) = self.poses.get(after).filter(|(t1, _)| *t1 - *t0 <= self.noise.max_gap)?;
        Some(a.interpolate(b, (stamp - *t0) / (*t1 - *t0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ranges_of_time_are_named() {
        let at = |seconds: i64| Stamp::from_nanos(seconds * 1_000_000_000);
        let poses = [(at(100), Pose2::IDENTITY), (at(200), Pose2::IDENTITY)];
        let prior = |poses| OdometryPrior {
            poses,
            base_from_camera: Pose3::identity(),
            noise: OdometryConfig::default(),
        };
        let apart = prior(&poses[..]).why_no_motion((at(1), at(2)));
        assert!(apart.contains("of 1.000000000 s to 2.000000000 s"), "{apart}");
        assert!(apart.contains("odometry of 100.000000000 s to 200.000000000 s"), "{apart}");
        assert!(apart.ends_with("expected one clock for both"), "{apart}");
        assert!(prior(&poses[..]).why_no_motion((at(150), at(151))).contains("expected poses at most"));
        assert!(prior(&[]).why_no_motion((at(1), at(2))).ends_with("it holds no pose"));
    }
}

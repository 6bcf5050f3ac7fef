use std::collections::VecDeque;
use trundle_core::{Odometry, Pose2, Stamp};

/// Where the odometry was in the last moments: for readings that are older than it.
#[derive(Debug, Default)]
pub(crate) struct OdometryTrack {
    poses: VecDeque<(Stamp, Pose2)>,
}

/// It reaches so far back, s.
const REACH: f64 = 2.0;

impl OdometryTrack {
    /// Takes down the newest odometry.
    pub(crate) fn note(&mut self, odometry: &Odometry) {
        self.poses.push_back((odometry.stamp, odometry.pose));
        while self.poses.front().is_some_and(|(stamp, _)| odometry.stamp - *stamp > REACH) {
            self.poses.pop_front();
        }
    }

    /// `odom_from_base` at `stamp`, between readings on a straight line, beyond them at the nearest; `None` before the first.
    pub(crate) fn at(&self, stamp: Stamp) -> Option<Pose2> {
        let after = self.poses.partition_point(|(at, _)| *at <= stamp);
        match (after.checked_sub(1).and_then(|i| self.poses.get(i)), self.poses.get(after)) {
            (Some((from, a)), Some((to, b))) => Some(a.interpolate(b, (stamp - *from) / (*to - *from))),
            (Some((_, pose)), None) | (None, Some((_, pose))) => Some(*pose),
            (None, None) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn odometry(stamp: Stamp, x: f64) -> Odometry {
        let covariance = nalgebra::Matrix3::zeros();
        Odometry { stamp, pose: Pose2::new(x, 0.0, 0.0), twist: trundle_core::Twist2::ZERO, covariance }
    }

    #[test]
    fn a_late_reading_finds_the_pose_of_its_own_time() {
        let mut track = OdometryTrack::default();
        assert_eq!(track.at(Stamp::default()), None);
        for i in 0..500 {
            let (stamp, x) = (Stamp::default().after(0.02 * f64::from(i)), f64::from(i));
            track.note(&odometry(stamp, x));
        }
        let at = |time: f64| track.at(Stamp::default().after(time)).unwrap().x;
        assert!((at(9.01) - 450.5).abs() < 1e-6 && at(99.0) == 499.0);
        assert_eq!(at(1.0), 399.0, "older than it remembers");
    }
}

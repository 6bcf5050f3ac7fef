//! The motion that a sensor measured over the last second, against the motion by wheels and gyro.

use crate::{odometry::state::OdometryState, planar::symmetric};
use nalgebra::Matrix3;
use std::collections::VecDeque;
use trundle_core::{Pose2, Stamp};

/// Poses by a sensor and by odometry over the last second.
///
/// Errors of a map and its frame are the same at both ends of a motion. What remains is the sensor's own noise, and a sensor that follows
/// something that moves shows a motion that wheels and gyro did not make.
#[derive(Debug, Clone, Default)]
pub(crate) struct MotionWindow(VecDeque<Entry>);

#[derive(Debug, Clone, Copy)]
struct Entry {
    stamp: Stamp,
    pose: Pose2,
    /// Of the pose, without what all poses of the window share.
    noise: Matrix3<f64>,
    odometry: OdometryState,
}

/// Length of the window \[s\]. Source: ours: a slow walker makes 0.4 m.
const WINDOW_S: f64 = 1.2;
/// Part of a motion that its own error may have \[1\]: the scale of depth and wheel radii. Source: ours.
const SCALE_SIGMA: f64 = 0.03;

impl MotionWindow {
    /// Adds a pose with its noise; returns the largest Mahalanobis distance of the motions up to it from those by odometry, `None`
    /// without a motion.
    pub(crate) fn add(
        &mut self,
        stamp: Stamp,
        pose: Pose2,
        noise: Matrix3<f64>,
        odometry: OdometryState,
    ) -> Option<f64> {
        if self.0.back().is_some_and(|last| stamp <= last.stamp) {
            return None;
        }
        let newest = Entry { stamp, pose, noise, odometry };
        self.0.retain(|entry| stamp - entry.stamp <= WINDOW_S);
        let distance = self.0.iter().map(|earlier| distance(earlier, &newest)).reduce(f64::max);
        self.0.push_back(newest);
        distance
    }

    /// The sensor's frame has moved.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }
}

/// Mahalanobis distance of the two motions.
fn distance(earlier: &Entry, newest: &Entry) -> f64 {
    let (by_wheels, wheel_noise) = newest.odometry.since(&earlier.odometry);
    let by_sensor = earlier.pose.inverse() * newest.pose;
    let off = (by_wheels.inverse() * by_sensor).log();
    let scale = Matrix3::from_diagonal(&(by_wheels.log() * SCALE_SIGMA).map(|sigma| sigma * sigma));
    let spread = symmetric(wheel_noise + scale + earlier.noise + newest.noise);
    spread.cholesky().map_or(0.0, |spread| off.dot(&spread.solve(&off)).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest distance in two seconds of a robot that drives at 0.3 m/s, with a sensor that drifts sideways at `drift` m/s.
    fn largest(drift: f64) -> f64 {
        let mut window = MotionWindow::default();
        let noise = Matrix3::from_diagonal_element(1e-4);
        let at = |i: u32| {
            let time = 0.1 * f64::from(i);
            let odometry =
                OdometryState { pose: Pose2::new(0.3 * time, 0.0, 0.0), covariance: noise * time * 0.1 };
            let pose = Pose2::new(0.3 * time, drift * time, 0.0);
            window.add(Stamp::default().after(time), pose, noise, odometry)
        };
        (0..20).filter_map(at).fold(0.0, f64::max)
    }

    #[test]
    fn a_sensor_that_moves_with_the_wheels_agrees_and_one_that_follows_a_walker_does_not() {
        assert!(largest(0.0) < 0.1 && largest(0.01) < 1.0, "{}", largest(0.01));
        assert!(largest(0.3) > 10.0, "{}", largest(0.3));
    }

    #[test]
    fn a_pose_of_the_past_is_ignored_and_a_cleared_window_is_empty() {
        let mut window = MotionWindow::default();
        let (noise, odometry) =
            (Matrix3::identity(), OdometryState { pose: Pose2::IDENTITY, covariance: Matrix3::zeros() });
        let at = |time| Stamp::default().after(time);
        assert_eq!(window.add(at(1.0), Pose2::IDENTITY, noise, odometry), None);
        assert_eq!(window.add(at(0.5), Pose2::IDENTITY, noise, odometry), None);
        assert!(window.add(at(1.5), Pose2::IDENTITY, noise, odometry).is_some());
        window.clear();
        assert_eq!(window.add(at(1.6), Pose2::IDENTITY, noise, odometry), None);
    }
}

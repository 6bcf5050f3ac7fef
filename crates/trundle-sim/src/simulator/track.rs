//! The recent true poses of the base, one per simulation step.

use crate::kobuki::STEPS_PER_SECOND;
use std::collections::VecDeque;
use trundle_core::Pose2;

/// Recent poses of the base, one per step.
#[derive(Debug, Clone)]
pub(super) struct Track {
    /// The newest first.
    poses: VecDeque<Pose2>,
    max: usize,
}

impl Track {
    /// A track over the last `seconds`; before its beginning the base was at `start`.
    pub(super) fn new(start: Pose2, seconds: f64) -> Self {
        let max = (seconds * STEPS_PER_SECOND).ceil() as usize + 2;
        Self { poses: VecDeque::from([start]), max }
    }

    /// Appends the pose of the next step.
    pub(super) fn add(&mut self, pose: Pose2) {
        self.poses.push_front(pose);
        self.poses.truncate(self.max);
    }

    /// Discards earlier poses: the base was moved to `pose`.
    pub(super) fn restart(&mut self, pose: Pose2) {
        self.poses.clear();
        self.poses.push_front(pose);
    }

    /// Pose of the base `age` s ago, interpolated linearly between steps; for a negative age, extrapolated by the last step.
    pub(super) fn back(&self, age: f64) -> Pose2 {
        let steps = age * STEPS_PER_SECOND;
        if steps < 0.0 {
            return self.ahead(-steps);
        }
        let last = self.poses.len() - 1;
        let newer = (steps.floor() as usize).min(last);
        let older = (newer + 1).min(last);
        self.poses[newer].interpolate(&self.poses[older], steps.fract())
    }

    fn ahead(&self, steps: f64) -> Pose2 {
        let now = self.poses[0];
        let before = self.poses.get(1).copied().unwrap_or(now);
        now * Pose2::exp((before.inverse() * now).log() * steps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_remembers_as_long_as_it_shall_and_interpolates() {
        let mut track = Track::new(Pose2::IDENTITY, 0.01);
        for i in 1..=100 {
            track.add(Pose2::new(f64::from(i), 0.0, 0.0));
        }
        assert_eq!(track.back(0.0).x, 100.0);
        assert!((track.back(0.0025).x - 97.5).abs() < 1e-9);
        assert_eq!((track.back(0.01).x, track.back(5.0).x), (90.0, 89.0));
        assert!((track.back(-0.0015).x - 101.5).abs() < 1e-9);
        track.restart(Pose2::new(7.0, 0.0, 0.0));
        assert_eq!((track.back(0.01).x, track.back(-0.01).x), (7.0, 7.0));
    }
}

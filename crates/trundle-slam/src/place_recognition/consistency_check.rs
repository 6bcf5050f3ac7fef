//! Counts successive findings of the same correction of a pose.

use crate::motion::motion_limits::MotionLimits;
use trundle_core::Pose3;

/// Largest difference between two corrections that still count as the same: 0.3 m and 0.3 rad. Beyond it the count restarts at one.
/// Source: ours.
const MAX_DIFFERENCE: f64 = 0.3;

/// A correction that must be found several times in a row before it is applied \[MurArtal17\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ConsistencyCheck<T> {
    /// Subject of the correction.
    subject: T,
    /// Motion from predicted to found poses, multiplied on the left.
    found_from_believed: Pose3,
    /// Number of successive findings.
    count: usize,
}

impl<T: PartialEq> ConsistencyCheck<T> {
    /// Records the found and the predicted pose of a camera; returns the number of successive findings of the same correction.
    /// `unobserved_s` is the time since the last record without a measurement of the motion, s: for that time the camera may have moved at
    /// its top speed.
    pub fn record(
        pending: &mut Option<Self>,
        subject: T,
        (found, believed): (Pose3, Pose3),
        unobserved_s: f64,
    ) -> usize {
        let is_near = |expected: Pose3| {
            MotionLimits::CAMERA.allow(expected.inverse() * found, MAX_DIFFERENCE, unobserved_s)
        };
        let is_same = |last: &Self| last.subject == subject && is_near(last.found_from_believed * believed);
        let count = 1 + pending.take().filter(is_same).map_or(0, |last| last.count);
        *pending = Some(Self { subject, found_from_believed: found * believed.inverse(), count });
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;
    use trundle_core::Vector3;

    fn at(x: f64, turned: f64) -> Pose3 {
        Pose3::new(UnitQuaternion::from_scaled_axis(Vector3::z() * turned), Vector3::x() * x)
    }

    #[test]
    fn only_the_same_correction_in_a_row_counts() {
        let mut pending = None;
        let mut record = |subject: u32, x: f64| {
            ConsistencyCheck::record(&mut pending, subject, (at(x, 0.0), Pose3::identity()), 0.0)
        };
        assert_eq!([record(1, 0.0), record(1, 0.1), record(1, 0.2), record(2, 0.2)], [1, 2, 3, 1]);
        assert_eq!([record(2, 0.3), record(2, 2.0), record(2, 2.0)], [2, 1, 2]);
    }

    #[test]
    fn a_camera_without_odometry_may_have_moved_meanwhile() {
        let again = |x: f64, unobserved_s: f64| {
            let mut pending = None;
            ConsistencyCheck::record(&mut pending, (), (at(0.0, 0.0), at(5.0, 0.0)), 0.0);
            ConsistencyCheck::record(&mut pending, (), (at(x, 0.0), at(5.0, 0.0)), unobserved_s)
        };
        assert_eq!([again(0.6, 0.0), again(0.6, 0.2), again(2.4, 0.2), again(2.2, 1.0)], [1, 2, 1, 2]);
    }

    #[test]
    fn corrections_are_compared_at_the_camera_not_at_the_origin() {
        let mut pending = None;
        let mut record = |found: Pose3, believed: Pose3| {
            ConsistencyCheck::record(&mut pending, (), (found, believed), 0.0)
        };
        // Far from the origin, a small turn of the camera moves the origin by metres.
        assert_eq!(record(at(20.0, 0.0), at(21.0, 0.0)), 1);
        assert_eq!(record(at(20.0, 0.1), at(21.0, 0.0)), 2);
        // The camera moves on, and the correction stays.
        assert_eq!(record(at(22.0, 0.1), at(23.0, 0.0)), 3);
        assert_eq!(record(at(22.0, 0.1), at(24.0, 0.0)), 1);
    }
}

//! Detection of images that follow a moving object, such as a person who fills the view.

use crate::odometry::state::OdometryState;
use crate::pose_monitor::scan_continuity::mean_residual;
use std::collections::VecDeque;
use trundle_core::{Pose2, Pose3, Scan, Stamp};

/// Compares the motion by images with that by wheels and gyro; two scans decide a contradiction.
///
/// Each motion predicts the present scan from a scan of a second ago. Map and estimate are not used, so that a wrong estimate cannot
/// confirm itself.
#[derive(Debug, Clone, Default)]
pub(crate) struct VisualMotionMonitor {
    window: VecDeque<Moment>,
    /// Number of the visual map of the window.
    map: u32,
    /// Last stamp at which images followed a moving object, since the visual frame was anchored.
    conflict: Option<Stamp>,
}

/// An image with the scan of its depth.
#[derive(Debug, Clone)]
struct Moment {
    stamp: Stamp,
    visual_from_base: Pose3,
    odometry: OdometryState,
    scan: Scan,
}

/// The motion by wheels and gyro.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MeasuredMotion {
    /// The odometry at the image.
    pub(crate) odometry: OdometryState,
    /// Whether wheels and gyro measure no motion.
    pub(crate) is_still: bool,
}

/// Verdict on the motion by images.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum VisualMotion {
    /// The robot's motion, or no contradiction.
    Own,
    /// The robot's motion: wheels or gyro measured another one, and two scans fit the images.
    OwnAgainstWheels,
    /// The motion of another object in view.
    Other,
    /// The robot's motion after that of another object: the frame of the visual map has moved.
    FrameMoved,
}

/// Duration of a compared motion \[s\]. Source: ours; a slow walker moves 0.3 m in this time.
const WINDOW_S: f64 = 1.0;
/// Largest difference of two agreeing motions \[m\]. Source: ours, the noise of a visual position.
const AGREEMENT_M: f64 = 0.025;
/// Largest difference of the turns of two agreeing motions \[rad\]: 1 deg. Source: ours.
const AGREEMENT_RAD: f64 = 0.0175;
/// Largest error of a distance as a fraction of it \[1\]: the scale of depth and wheel radii. Source: ours.
const SCALE_ERROR: f64 = 0.05;
/// Number of standard deviations of a turn by wheels and gyro within which images agree with it \[1\]. Source: ours, three sigma.
const TURN_SIGMAS: f64 = 3.0;
/// Difference of the mean range residuals above which scans decide \[m\]. Source: ours, the noise of a mean.
const DECISIVE_RESIDUAL_M: f64 = 0.004;
/// Time without a contradiction after which the visual map counts as fixed again \[s\]. Source: ours.
const CALM_S: f64 = 1.5;

/// Motion by the wheels of a base at rest \[m\]. Source: ours, ten ticks of a Kobuki.
const REST_M: f64 = 1e-3;
/// Turn by the gyro of a base at rest \[rad\]: 0.1 deg. Source: ours.
const REST_RAD: f64 = 1.75e-3;

impl VisualMotionMonitor {
    /// Records a located image of a visual map, with the scan of its depth.
    pub(crate) fn add(
        &mut self,
        (map, visual_from_base): (u32, Pose3),
        measured: MeasuredMotion,
        scan: &Scan,
    ) -> VisualMotion {
        let stamp = scan.stamp();
        let is_earlier = self.window.back().is_some_and(|newest| stamp < newest.stamp);
        if map != self.map || is_earlier {
            self.map = map;
            self.restart();
        }
        self.window.retain(|moment| stamp - moment.stamp <= WINDOW_S);
        let MeasuredMotion { odometry, is_still } = measured;
        let newest = Moment { stamp, visual_from_base, odometry, scan: scan.clone() };
        let is_other = self.window.front().and_then(|earlier| newest.follows_another(earlier, is_still));
        self.window.push_back(newest);
        match is_other {
            Some(true) => self.conflict = Some(stamp),
            Some(false) => self.conflict = None,
            None => {}
        }
        match self.conflict {
            None if is_other == Some(false) => VisualMotion::OwnAgainstWheels,
            None => VisualMotion::Own,
            Some(at) if stamp - at <= CALM_S => VisualMotion::Other,
            Some(_) => VisualMotion::FrameMoved,
        }
    }

    /// Restarts after the visual frame was anchored again: no contradiction is left.
    pub(crate) fn restart(&mut self) {
        self.interrupt();
        self.conflict = None;
    }

    /// The visual map was corrected, or a place was recognised: motions across this event are invalid. A contradiction before it stays: the
    /// recognised landmarks may be those of the moving object.
    pub(crate) fn interrupt(&mut self) {
        self.window.clear();
    }
}

impl Moment {
    /// Whether the motion by images since `earlier` is that of another object. `Some(false)`: the robot's, against the wheels. `None`:
    /// images and wheels agree, or scans do not decide. A person who fills the view moves scans and images alike, but not wheels and gyro:
    /// for a base that is still, scans do not decide.
    fn follows_another(&self, earlier: &Self, is_still: bool) -> Option<bool> {
        let (by_wheels, covariance) = self.odometry.since(&earlier.odometry);
        let by_images = (earlier.visual_from_base.inverse() * self.visual_from_base).to_pose2();
        let off = by_wheels.inverse() * by_images;
        let is_same = off.position().norm() <= AGREEMENT_M + SCALE_ERROR * by_wheels.position().norm()
            && off.theta.abs() <= AGREEMENT_RAD + TURN_SIGMAS * covariance[(2, 2)].max(0.0).sqrt();
        if is_same {
            return None;
        }
        if is_still && is_at_rest(&by_wheels) {
            return Some(true);
        }
        let residual = |motion: Pose2| mean_residual(&earlier.scan, motion.inverse(), &self.scan);
        let excess = residual(by_images)? - residual(by_wheels)?;
        (excess.abs() > DECISIVE_RESIDUAL_M).then_some(excess > 0.0)
    }
}

/// Whether a motion by wheels and gyro is none.
fn is_at_rest(by_wheels: &Pose2) -> bool {
    by_wheels.position().norm() <= REST_M && by_wheels.theta.abs() <= REST_RAD
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose_monitor::testing::Room;
    use nalgebra::{Matrix3, Vector3};

    fn by_wheels(pose: Pose2) -> OdometryState {
        OdometryState { pose, covariance: Matrix3::zeros() }
    }

    fn moving(odom_from_base: Pose2) -> MeasuredMotion {
        MeasuredMotion { odometry: by_wheels(odom_from_base), is_still: false }
    }

    /// Verdicts on images every 0.1 s for a robot whose wheels, images and body move along x with these speeds, m/s.
    fn motions(
        by_wheels: impl Fn(f64) -> f64,
        by_images: impl Fn(f64) -> f64,
        truth: impl Fn(f64) -> f64,
    ) -> Vec<VisualMotion> {
        let mut monitor = VisualMotionMonitor::default();
        let at = |i: u32| {
            let time = 0.1 * f64::from(i);
            let pose = |x: f64| Pose2::new(x, 0.0, 0.0);
            let scan = Room::with_corner_box().scan(pose(truth(time)), time);
            let motion = monitor.add(
                (0, Pose3::from_pose2(pose(by_images(time)))),
                moving(pose(by_wheels(time))),
                &scan,
            );
            if motion == VisualMotion::FrameMoved {
                monitor.restart();
            }
            motion
        };
        (0..60).map(at).collect()
    }

    /// Position of a walker who moves 0.3 m in the second second.
    fn walker(time: f64) -> f64 {
        0.3 * (time - 1.0).clamp(0.0, 1.0)
    }

    #[test]
    fn images_of_a_walker_are_left_out_and_their_frame_is_anchored_anew_once_he_stands() {
        let all = motions(|_| 0.0, walker, |_| 0.0);
        let own = all.iter().take_while(|motion| **motion == VisualMotion::Own).count();
        assert!((11..=13).contains(&own), "{own}");
        let moved: Vec<usize> = (0..60).filter(|i| all[*i] == VisualMotion::FrameMoved).collect();
        assert!(moved.len() == 1 && (35..=50).contains(&moved[0]), "{moved:?}");
        assert!(all[moved[0] + 1..].iter().all(|motion| *motion == VisualMotion::Own));
    }

    #[test]
    fn images_are_believed_against_wheels_that_slip() {
        let is_own =
            |motion: &VisualMotion| matches!(motion, VisualMotion::Own | VisualMotion::OwnAgainstWheels);
        for (all, why) in [
            (motions(walker, |_| 0.0, |_| 0.0), "the wheels spin"),
            (motions(|_| 0.0, walker, walker), "the robot is pushed"),
        ] {
            assert!(all.iter().all(is_own), "{why}");
            assert!(all.contains(&VisualMotion::OwnAgainstWheels), "{why}");
        }
    }

    #[test]
    fn another_visual_map_is_no_motion() {
        let mut monitor = VisualMotionMonitor::default();
        let scan = |time| Room::with_corner_box().scan(Pose2::IDENTITY, time);
        let at = |x: f64| Pose3::from_pose2(Pose2::new(x, 0.0, 0.0));
        for (i, (map, x)) in [(0, 0.0), (0, 0.0), (1, 5.0), (1, 5.0), (0, 0.0)].into_iter().enumerate() {
            let motion = monitor.add((map, at(x)), moving(Pose2::IDENTITY), &scan(0.1 * i as f64));
            assert_eq!(motion, VisualMotion::Own);
        }
    }

    #[test]
    fn a_person_who_moves_in_all_of_the_view_does_not_move_a_base_that_is_still() {
        // The scan follows the person as well: it is that of a robot that moves the other way.
        for (is_still, slow, expected) in [
            (true, 0.0, VisualMotion::Other),
            (true, 0.01, VisualMotion::OwnAgainstWheels),
            (false, 0.0, VisualMotion::OwnAgainstWheels),
        ] {
            let mut monitor = VisualMotionMonitor::default();
            let verdicts = (0..12).map(|i| {
                let time = 0.05 * f64::from(i);
                let person = Pose2::new(0.5 * time, 0.0, 0.0);
                let scan = Room::with_corner_box().scan(person, time);
                let odometry = by_wheels(Pose2::new(slow * time, 0.0, 0.0));
                let measured = MeasuredMotion { odometry, is_still };
                monitor.add((0, Pose3::from_pose2(person)), measured, &scan)
            });
            assert_eq!(verdicts.last(), Some(expected), "{is_still} {slow}");
        }
    }

    #[test]
    fn a_recognised_place_does_not_end_a_contradiction() {
        let mut monitor = VisualMotionMonitor::default();
        let images = |i: u32| walker(0.1 * f64::from(i) + 1.0);
        let add = |i: u32, monitor: &mut VisualMotionMonitor| {
            let scan = Room::with_corner_box().scan(Pose2::IDENTITY, 0.1 * f64::from(i));
            let visual = Pose3::from_pose2(Pose2::new(images(i), 0.0, 0.0));
            monitor.add((0, visual), moving(Pose2::IDENTITY), &scan)
        };
        let before = (0..6).map(|i| add(i, &mut monitor)).last();
        assert_eq!(before, Some(VisualMotion::Other));
        monitor.interrupt();
        assert_eq!(add(6, &mut monitor), VisualMotion::Other);
        monitor.restart();
        assert_eq!(add(7, &mut monitor), VisualMotion::Own);
    }

    #[test]
    fn a_turn_by_images_agrees_within_the_uncertainty_of_the_turn_by_the_gyro() {
        let off = 0.04;
        for (sigma, expected) in [(0.003, VisualMotion::Other), (0.01, VisualMotion::Own)] {
            let mut monitor = VisualMotionMonitor::default();
            let verdicts = (0..10).map(|i| {
                let time = 0.1 * f64::from(i);
                let (turn, found) = (0.7 * time, (0.7 + off) * time);
                let covariance = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, sigma * sigma * time));
                let odometry = OdometryState { pose: Pose2::new(0.0, 0.0, turn), covariance };
                let scan = Room::with_corner_box().scan(odometry.pose, time);
                let visual = Pose3::from_pose2(Pose2::new(0.0, 0.0, found));
                monitor.add((0, visual), MeasuredMotion { odometry, is_still: false }, &scan)
            });
            assert_eq!(verdicts.last(), Some(expected), "{sigma}");
        }
    }
}

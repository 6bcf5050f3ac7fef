//! The pose monitor: decides the use of visual poses, and detects a displacement of the robot.

use crate::fusion::correction::VisualPose;
use crate::odometry::state::OdometryState;
use crate::pose_monitor::displacement::{DisplacementMonitor, ImageEvidence, VisualUse};
use crate::pose_monitor::recent_scans::RecentScans;
use crate::pose_monitor::visual_jump::{Drift, PoseBelief, VisualJump};
use crate::pose_monitor::visual_motion::{MeasuredMotion, VisualMotion, VisualMotionMonitor};
use trundle_core::{OccupancyGrid, Pose2, Pose3, Scan, Stamp};

/// Decides the use of visual poses, and whether the robot was carried away.
///
/// Problem: in look-alike rooms, and with moving people in view, images can give a wrong pose. Method: three questions, each with its own
/// evidence.
///
/// 1. Was the robot carried away? Evidence: odometry does not explain the difference of two successive scans, or a wheel dropped.
/// 2. Do images follow a moving object? Evidence: images and wheels measure different motions, and two scans fit the wheels.
/// 3. Is a recognised place a look-alike? Evidence: the visual pose is away from the estimate, and the scans of the last seconds fit the
///    map worse there.
///
/// After a displacement, a visual pose anywhere is accepted unless the scans fit the pose by the odometry far better: people near the robot
/// can break the sequence of scans, too. Otherwise odometry and scans determine the pose. Cost: one comparison of two
/// scans per image; for a visual pose away from the estimate, one ray per 5 deg of twelve scans.
#[derive(Debug, Clone, Default)]
pub struct PoseMonitor {
    displacement: DisplacementMonitor,
    motion: VisualMotionMonitor,
    recent: RecentScans,
    /// Last stamp at which two scans showed that wheels or gyro were wrong.
    wrong_odometry: Option<Stamp>,
}

/// Time after an error of wheels or gyro in which the drift may exceed the standard deviations \[s\]. Source: ours, the maximum age of the
/// scans in a comparison.
const WRONG_ODOMETRY_S: f64 = 20.0;

/// Log-likelihood ratio of the scans, against ranges at random, above which they confirm a pose \[nats\]. Source: ours, 400 to 1.
const CONFIRMED_NATS: f64 = 6.0;

/// Number of scans from different poses that end the evidence of a displacement. Source: ours, a turn by 30 deg or 1 m.
const CONFIRMING_SCANS: usize = 4;

/// A visual pose with the evidence for its verdict.
#[derive(Debug, Clone, Copy)]
pub struct VisualEvidence<'a> {
    /// The visual pose.
    pub visual: &'a VisualPose,
    /// Whether the visual map was just corrected: earlier poses then give no motion.
    pub is_corrected: bool,
    /// Pose of the base in the frame of the visual map.
    pub visual_from_base: Pose3,
    /// `map_from_base` by the visual pose; `None` before its visual map is anchored.
    pub found: Option<Pose2>,
    /// The odometry at the image; `None` if the image is too old.
    pub odometry: Option<OdometryState>,
    /// Whether wheels and gyro measure no motion.
    pub is_still: bool,
    /// The scan of the image's depth.
    pub scan: Option<&'a Scan>,
    /// The estimate at the image; `None` if the image is too old.
    pub belief: Option<PoseBelief>,
    /// The map, without this scan.
    pub grid: &'a OccupancyGrid,
}

/// Use of a visual pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VisualVerdict {
    /// The pose corrects the estimate, by its covariance.
    Accepted,
    /// The pose follows a moving object, or tracking continued from a wrong pose after a displacement.
    Ignored,
    /// The frame of the visual map has moved; the map is anchored again at the estimate.
    FrameMoved,
    /// The recognised place is a look-alike.
    FalseRecognition,
}

impl PoseMonitor {
    /// Records a scan taken at `odom_from_base`.
    pub fn add_scan(&mut self, odom_from_base: Pose2, scan: &Scan) {
        if self.displacement.add_scan(odom_from_base, scan) {
            self.recent.restart(odom_from_base, Some(scan));
        } else {
            self.recent.add(odom_from_base, scan);
        }
    }

    /// Records a wheel drop.
    pub fn add_lift(&mut self, now: Stamp) {
        self.displacement.add_lift(now);
    }

    /// The use of a visual pose.
    pub fn judge(&mut self, evidence: &VisualEvidence<'_>) -> VisualVerdict {
        let visual_use = self.displacement.visual_use(evidence.visual.recognised);
        let motion = if visual_use == VisualUse::Checked {
            self.motion_of(evidence)
        } else {
            self.motion.restart();
            VisualMotion::Own
        };
        match (visual_use, motion) {
            (VisualUse::Nothing, _) | (_, VisualMotion::Other) => return VisualVerdict::Ignored,
            (_, VisualMotion::FrameMoved) => return VisualVerdict::FrameMoved,
            (_, VisualMotion::OwnAgainstWheels) => {
                self.wrong_odometry = Some(evidence.visual.stamp);
                if let Some(odometry) = evidence.odometry {
                    self.recent.restart(odometry.pose, evidence.scan);
                }
            }
            (_, VisualMotion::Own) => {}
        }
        let VisualEvidence { visual, found, belief, grid, odometry, .. } = *evidence;
        let Some(((found, belief), odometry)) = found.zip(belief).zip(odometry) else {
            return VisualVerdict::Accepted;
        };
        let is_odometry_wrong =
            self.wrong_odometry.is_some_and(|since| visual.stamp - since <= WRONG_ODOMETRY_S);
        let drift = Drift {
            belief,
            is_odometry_wrong,
            is_displaced: visual_use == VisualUse::Anywhere,
            is_corrected: visual.recognised || evidence.is_corrected,
        };
        match VisualJump::judge(&drift, found, odometry.pose, (&self.recent, grid)) {
            VisualJump::Allowed => VisualVerdict::Accepted,
            VisualJump::Refused if visual.recognised && !evidence.is_corrected => {
                VisualVerdict::FalseRecognition
            }
            VisualJump::Refused => VisualVerdict::FrameMoved,
        }
    }

    /// Records the evidence of an image. Returns whether the robot is displaced and global localization begins.
    pub fn add_image(&mut self, now: Stamp, evidence: ImageEvidence) -> bool {
        self.displacement.add_image(now, evidence)
    }

    /// Records that scans gave the pose. Unlocated images do not make the pose unknown again until an image is located.
    pub fn localized_by_scans(&mut self) {
        self.displacement.localized_by_scans();
    }

    /// Whether the scans since the last evidence of a displacement fit the map at `map_from_base`, with the odometry at `odom_from_base`. A
    /// person who steps in front of the camera breaks the sequence of scans; the parts of the view beside the person then fit the pose.
    pub fn is_confirmed_by_scans(
        &self,
        grid: &OccupancyGrid,
        map_from_base: Pose2,
        odom_from_base: Pose2,
    ) -> bool {
        self.recent.log_likelihood(grid, map_from_base, odom_from_base) > CONFIRMED_NATS
    }

    /// Ends the evidence of a displacement if the scans since then, from several poses, fit the map at `map_from_base`, with the odometry at
    /// `odom_from_base`.
    pub fn confirm_by_scans(&mut self, grid: &OccupancyGrid, map_from_base: Pose2, odom_from_base: Pose2) {
        let needed = CONFIRMING_SCANS as f64 * CONFIRMED_NATS;
        if self.recent.len() >= CONFIRMING_SCANS
            && self.recent.log_likelihood(grid, map_from_base, odom_from_base) > needed
        {
            self.displacement.settle();
        }
    }

    /// Whether there is evidence that the robot was carried away.
    pub fn is_displaced(&self) -> bool {
        self.displacement.is_displaced()
    }

    /// Whether two scans contradict the odometry, and neither an image nor a scan has confirmed the pose since.
    pub fn is_contradicted(&self) -> bool {
        self.displacement.is_certain()
    }

    /// Whether the robot may be displaced, by images of a short time. Mapping then pauses.
    pub fn is_doubtful(&self, now: Stamp) -> bool {
        self.displacement.is_doubtful(now)
    }

    /// Verdict on the motion by images. A recognition interrupts the motion.
    fn motion_of(&mut self, evidence: &VisualEvidence<'_>) -> VisualMotion {
        let VisualEvidence { visual, visual_from_base, odometry, is_still, scan, .. } = *evidence;
        if visual.recognised {
            self.motion.interrupt();
        }
        let Some((scan, odometry)) = scan.zip(odometry) else { return VisualMotion::Own };
        let measured = MeasuredMotion { odometry, is_still };
        let motion = self.motion.add((visual.map, visual_from_base), measured, scan);
        if motion == VisualMotion::FrameMoved {
            self.motion.restart();
        }
        motion
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose_monitor::testing::Room;
    use trundle_core::Vector2;

    const START: Pose2 = Pose2 { x: -0.6, y: 0.2, theta: 0.3 };

    /// A monitor after a sudden other view at the second scan, a turn by 75 deg and `turns` turns by 15 deg each; the scans after the first
    /// are those of a robot that is `off` away from its odometry. With it, the odometry.
    fn contradicted(off: Pose2, turns: u32) -> (PoseMonitor, Pose2) {
        let room = Room::with_corner_box();
        let mut monitor = PoseMonitor::default();
        monitor.add_scan(START, &room.scan(START, 0.0));
        let person = room.clone().with_person(START.transform(Vector2::new(0.5, 0.0)));
        let mut odom = START;
        for i in 0..=turns {
            let angle = if i == 0 { 0.0 } else { 1.3 + 0.26 * f64::from(i) };
            odom = START * Pose2::new(0.0, 0.0, angle);
            let seen = if off == Pose2::IDENTITY && i == 0 { &person } else { &room };
            let at = (START * off) * (START.inverse() * odom);
            monitor.add_scan(odom, &seen.scan(at, 0.1 * f64::from(i + 1)));
        }
        (monitor, odom)
    }

    #[test]
    fn a_person_before_the_camera_contradicts_the_pose_until_scans_from_several_poses_confirm_it() {
        let map = Room::with_corner_box().map();
        for (turns, is_contradicted) in [(0, true), (2, true), (5, false)] {
            let (mut monitor, odom) = contradicted(Pose2::IDENTITY, turns);
            monitor.confirm_by_scans(&map, odom, odom);
            assert_eq!(monitor.is_contradicted(), is_contradicted, "{turns} turns");
        }
    }

    #[test]
    fn scans_of_a_robot_that_was_carried_do_not_confirm_the_pose_by_its_odometry() {
        let map = Room::with_corner_box().map();
        for off in [Pose2::new(0.9, 0.4, 0.6), Pose2::new(0.4, -0.6, -1.2)] {
            let (mut monitor, odom) = contradicted(off, 8);
            assert!(monitor.is_contradicted(), "{off:?}");
            assert!(!monitor.is_confirmed_by_scans(&map, odom, odom), "{off:?}");
            monitor.confirm_by_scans(&map, odom, odom);
            assert!(monitor.is_contradicted(), "{off:?}");
            let truth = (START * off) * (START.inverse() * odom);
            monitor.confirm_by_scans(&map, truth, odom);
            assert!(!monitor.is_contradicted(), "the true pose: {off:?}");
        }
    }
}

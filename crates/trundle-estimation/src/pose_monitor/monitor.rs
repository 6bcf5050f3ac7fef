//! The pose monitor: decides the use of visual poses, and detects a displacement of the robot.

use crate::fusion::correction::VisualPose;
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
/// After a displacement, a visual pose anywhere is accepted. Otherwise odometry and scans determine the pose. Cost: one comparison of two
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
    /// Pose by the odometry at the image.
    pub odom_from_base: Pose2,
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
        let unchecked = match self.displacement.visual_use(evidence.visual.recognised) {
            VisualUse::Checked => None,
            VisualUse::Anywhere => Some(VisualVerdict::Accepted),
            VisualUse::Nothing => Some(VisualVerdict::Ignored),
        };
        if let Some(verdict) = unchecked {
            self.motion.restart();
            return verdict;
        }
        match self.motion_of(evidence) {
            VisualMotion::Own => {}
            VisualMotion::OwnAgainstWheels => {
                self.wrong_odometry = Some(evidence.visual.stamp);
                self.recent.restart(evidence.odom_from_base, evidence.scan);
            }
            VisualMotion::Other => return VisualVerdict::Ignored,
            VisualMotion::FrameMoved => return VisualVerdict::FrameMoved,
        }
        let VisualEvidence { visual, found, belief, grid, odom_from_base, .. } = *evidence;
        let Some((found, belief)) = found.zip(belief) else { return VisualVerdict::Accepted };
        let is_odometry_wrong =
            self.wrong_odometry.is_some_and(|since| visual.stamp - since <= WRONG_ODOMETRY_S);
        let drift = Drift { belief, is_odometry_wrong };
        match VisualJump::judge(&drift, found, odom_from_base, (&self.recent, grid)) {
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

    /// Whether there is evidence that the robot was carried away.
    pub fn is_displaced(&self) -> bool {
        self.displacement.is_displaced()
    }

    /// Whether the robot may be displaced, by images of a short time. Mapping then pauses.
    pub fn is_doubtful(&self, now: Stamp) -> bool {
        self.displacement.is_doubtful(now)
    }

    /// Verdict on the motion by images. A recognition interrupts the motion.
    fn motion_of(&mut self, evidence: &VisualEvidence<'_>) -> VisualMotion {
        let VisualEvidence { visual, visual_from_base, odom_from_base, is_still, scan, .. } = *evidence;
        if visual.recognised {
            self.motion.restart();
        }
        let Some(scan) = scan else { return VisualMotion::Own };
        let odometry = MeasuredMotion { odom_from_base, is_still };
        let motion = self.motion.add((visual.map, visual_from_base), odometry, scan);
        if motion == VisualMotion::FrameMoved {
            self.motion.restart();
        }
        motion
    }
}

//! The pose monitor: which visual poses may correct the estimate, and when the robot is elsewhere.

use crate::fusion::correction::VisualPose;
use crate::pose_monitor::displacement::{DisplacementMonitor, ImageEvidence, VisualUse};
use crate::pose_monitor::recent_scans::RecentScans;
use crate::pose_monitor::visual_jump::{Drift, PoseBelief, VisualJump};
use crate::pose_monitor::visual_motion::{VisualMotion, VisualMotionMonitor};
use trundle_core::{OccupancyGrid, Pose2, Pose3, Scan, Stamp};

/// Decides what a visual pose is used for, and whether the robot was carried away.
///
/// Problem: in rooms that look alike, and before people who move, images show a pose where the robot is not. Method: three questions, each
/// with its own evidence.
///
/// 1. Was the robot carried away? Two successive scans do not follow from each other by odometry, or a wheel hung.
/// 2. Do images follow something that moves? Images and wheels measure different motions, and two scans fit the wheels.
/// 3. Is a place recognised where the robot is not? The visual pose lies away from the estimate, and the scans of the last
///    seconds fit the map worse there.
///
/// A robot that was carried away is located anywhere. Any other stays where odometry and scans lead. Cost: one comparison of two scans for
/// each image, and one ray for each 5 deg of twelve scans for a visual pose away from the estimate.
#[derive(Debug, Clone, Default)]
pub struct PoseMonitor {
    displacement: DisplacementMonitor,
    motion: VisualMotionMonitor,
    recent: RecentScans,
    /// When two scans last showed that wheels or gyro were wrong.
    wrong_odometry: Option<Stamp>,
}

/// Time after wheels or gyro were wrong during which the estimate may have drifted beyond its standard deviations \[s\]. Source: ours, the
/// age of the scans that odometry joins.
const WRONG_ODOMETRY_S: f64 = 20.0;

/// A visual pose with all that it is judged by.
#[derive(Debug, Clone, Copy)]
pub struct VisualEvidence<'a> {
    /// The visual pose.
    pub visual: &'a VisualPose,
    /// Whether the visual map was just corrected: its poses from before say nothing of the motion.
    pub is_corrected: bool,
    /// The base in the frame of the visual map.
    pub visual_from_base: Pose3,
    /// `map_from_base` by the visual pose; `None` before its visual map is anchored.
    pub found: Option<Pose2>,
    /// The odometry at the image.
    pub odom_from_base: Pose2,
    /// The scan of the image's depth.
    pub scan: Option<&'a Scan>,
    /// The estimate at the image; `None` where it does not reach back.
    pub belief: Option<PoseBelief>,
    /// The map, without this scan.
    pub grid: &'a OccupancyGrid,
}

/// Use of a visual pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VisualVerdict {
    /// It corrects the estimate, by its covariance.
    Accepted,
    /// It follows something that moves, or tracking went on from a wrong pose after the robot was carried away.
    Ignored,
    /// The frame of its visual map has moved: it is anchored anew at the estimate.
    FrameMoved,
    /// A place was recognised where the robot is not.
    FalseRecognition,
}

impl PoseMonitor {
    /// Takes in a scan, taken at `odom_from_base`.
    pub fn add_scan(&mut self, odom_from_base: Pose2, scan: &Scan) {
        if self.displacement.add_scan(odom_from_base, scan) {
            self.recent.restart(odom_from_base, Some(scan));
        } else {
            self.recent.add(odom_from_base, scan);
        }
    }

    /// A wheel hangs.
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

    /// Takes in what an image shows of the place. Whether the robot is elsewhere: global localization begins.
    pub fn add_image(&mut self, now: Stamp, evidence: ImageEvidence) -> bool {
        self.displacement.add_image(now, evidence)
    }

    /// Scans gave the pose. Images that are not located do not make it unknown again until one is located.
    pub fn localized_by_scans(&mut self) {
        self.displacement.localized_by_scans();
    }

    /// Whether there is evidence that the robot was carried away.
    pub fn is_displaced(&self) -> bool {
        self.displacement.is_displaced()
    }

    /// Whether images have shown for a short time that the robot may be elsewhere: nothing enters the map.
    pub fn is_doubtful(&self, now: Stamp) -> bool {
        self.displacement.is_doubtful(now)
    }

    /// What the images move with. Across a recognition there is no motion.
    fn motion_of(&mut self, evidence: &VisualEvidence<'_>) -> VisualMotion {
        let VisualEvidence { visual, visual_from_base, odom_from_base, scan, .. } = *evidence;
        if visual.recognised {
            self.motion.restart();
        }
        let Some(scan) = scan else { return VisualMotion::Own };
        let motion = self.motion.add((visual.map, visual_from_base), odom_from_base, scan);
        if motion == VisualMotion::FrameMoved {
            self.motion.restart();
        }
        motion
    }
}

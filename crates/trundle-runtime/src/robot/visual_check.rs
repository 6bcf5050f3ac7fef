//! Check of visual poses by scans, against look-alike places and moving objects.

use super::{Robot, event_log};
use crate::{stage::Stage, workers::perception_worker::MIN_FEATURES_TO_LOCATE};
use trundle_core::{Pose2, Scan, Stamp};
use trundle_estimation::{Correction, ImageEvidence, PoseBelief, VisualEvidence, VisualPose, VisualVerdict};
use trundle_slam::TrackReport;

impl Robot {
    /// The use of a visual pose, taken with `scan`.
    pub(super) fn judge_visual_pose(
        &mut self,
        visual: &VisualPose,
        is_corrected: bool,
        scan: Option<&Scan>,
    ) -> VisualVerdict {
        let belief = self.belief_at(visual.stamp);
        self.latest.pose_monitor.judge(&VisualEvidence {
            visual,
            is_corrected,
            visual_from_base: visual.visual_from_camera * self.base_from_camera.inverse(),
            found: self.localizer.base_by_visual(visual),
            odometry: self.localizer.odometry_at(visual.stamp).ok(),
            is_still: self.odometry.is_still(),
            scan,
            belief,
            grid: self.mapping.grid(),
        })
    }

    fn belief_at(&self, stamp: Stamp) -> Option<PoseBelief> {
        let estimate = self.localizer.estimate();
        Some(PoseBelief {
            pose: self.localizer.pose_at(stamp).ok()?,
            position_sigma: estimate.position_sigma(),
            heading_sigma: estimate.heading_sigma(),
        })
    }

    /// Corrects the estimate by a visual pose.
    pub(super) fn correct_by_image(&mut self, visual: &VisualPose, verdict: VisualVerdict) -> Correction {
        event_log::visual_verdict(visual.stamp, verdict);
        let (times, localizer) = (&mut self.times, &mut self.localizer);
        let refused = Correction::Gated { distance: f64::INFINITY };
        match verdict {
            VisualVerdict::Accepted => {
                times.measure(Stage::Localization, || localizer.correct_visual(visual))
            }
            VisualVerdict::Ignored => refused,
            VisualVerdict::FrameMoved => localizer.anchor_again(visual),
            VisualVerdict::FalseRecognition => {
                self.perception.iter_mut().for_each(|perception| perception.kidnapped());
                refused
            }
        }
    }

    /// Passes the evidence of an image, taken at `odom_from_base`, to the pose monitor. Without evidence of a displacement, odometry and
    /// scans continue the pose. With evidence, the pose is lost unless the scans since then fit it.
    pub(super) fn add_image_evidence(
        &mut self,
        track: &TrackReport,
        verdict: Option<VisualVerdict>,
        correction: Option<Correction>,
        odom_from_base: Pose2,
    ) {
        let is_used = correction.is_some_and(|correction| correction.is_used());
        let evidence = match verdict {
            Some(VisualVerdict::Accepted) if is_used && track.relocalised => ImageEvidence::Recognised,
            Some(VisualVerdict::Accepted) if is_used => ImageEvidence::Tracked,
            None if track.features < MIN_FEATURES_TO_LOCATE => ImageEvidence::Blind,
            _ => ImageEvidence::Unlocated,
        };
        if matches!(evidence, ImageEvidence::Recognised | ImageEvidence::Tracked) {
            self.latest.located = self.latest.located.max(Some(track.stamp));
        }
        if !self.latest.pose_monitor.add_image(track.stamp, evidence) {
            return;
        }
        let (monitor, grid) = (&self.latest.pose_monitor, self.mapping.grid());
        let pose = self.localizer.pose_at(track.stamp);
        if pose.is_ok_and(|pose| monitor.is_confirmed_by_scans(grid, pose, odom_from_base)) {
            self.perception.iter_mut().for_each(|perception| perception.kidnapped());
        } else {
            self.carried_away();
        }
    }
}

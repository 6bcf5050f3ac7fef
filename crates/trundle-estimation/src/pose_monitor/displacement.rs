//! Evidence from images, scans and the base that the robot was carried away.

use crate::pose_monitor::scan_continuity::{Continuity, ScanContinuity};
use trundle_core::{Pose2, Scan, Stamp};

/// Evidence that the robot is not at the pose of the odometry.
///
/// Images that are not located, and scans that contradict the map, are no such evidence: people and moved furniture cause both. A break in
/// the sequence of scans is certain evidence. A doubtful sequence, a time without scans, and a wheel drop are possible evidence, which
/// needs images with enough features that are not located.
///
/// Evidence ends with a recognised place, or with a scan that shows the surfaces from before the break. A tracked image ends it only if
/// tracking has not paused since the evidence: after a pause, tracking continues from the odometry's pose.
#[derive(Debug, Clone, Default)]
pub(crate) struct DisplacementMonitor {
    continuity: ScanContinuity,
    evidence: Option<Evidence>,
    /// Start of the time in which images with enough features are not located.
    unlocated: Option<Stamp>,
    /// Last start of global localization in that time.
    searched: Option<Stamp>,
    /// Whether global localization by scans gave the last pose.
    is_placed_by_scans: bool,
}

/// Evidence of displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Evidence {
    since: Stamp,
    /// Whether two successive scans contradict the odometry.
    is_certain: bool,
    /// Whether an image was not located since the evidence.
    is_track_cut: bool,
}

/// Evidence of an image about the robot's place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageEvidence {
    /// A place was recognised, and the pose accepted.
    Recognised,
    /// The image was tracked from the previous one, and the pose accepted.
    Tracked,
    /// The image has enough features, but was not located.
    Unlocated,
    /// The image has too few features for a location.
    Blind,
}

/// Allowed use of a visual pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum VisualUse {
    /// The pose corrects the estimate, if scans and motion agree.
    Checked,
    /// The pose is accepted anywhere.
    Anywhere,
    /// The pose is not used: tracking continued from a wrong pose.
    Nothing,
}

/// Time after the evidence without a located image \[s\] after which the robot counts as displaced. It is shorter than the 30 images at 30
/// Hz after which visual tracking continues from the odometry's pose. Source: ours.
const DISPLACED_AFTER_S: f64 = 0.8;
/// Time between two starts of global localization \[s\]. Source: ours.
const SEARCH_AGAIN_S: f64 = 1.5;
/// Time after certain evidence \[s\] after which a robot with images of too few features counts as displaced. Source: ours; a scan that
/// contradicts the map decides sooner.
const BLIND_DISPLACED_AFTER_S: f64 = 3.0;
/// Time after the evidence without a located image \[s\] after which the pose is doubtful and mapping pauses. Source: ours; longer than a
/// few blurred images.
const DOUBTFUL_AFTER_S: f64 = 0.3;

impl DisplacementMonitor {
    /// Records a scan taken at `odom_from_base`. Returns whether odometry does not explain its difference from the previous scans.
    pub(crate) fn add_scan(&mut self, odom_from_base: Pose2, scan: &Scan) -> bool {
        let continuity = self.continuity.add(odom_from_base, scan);
        match continuity {
            Continuity::Continuous => {}
            Continuity::Broken => self.is_displaced_since(scan.stamp()),
            Continuity::Doubtful | Continuity::Unknown => self.may_be_displaced(scan.stamp()),
            Continuity::Restored => self.evidence = None,
        }
        matches!(continuity, Continuity::Broken | Continuity::Unknown)
    }

    /// Records a wheel drop.
    pub(crate) fn add_lift(&mut self, now: Stamp) {
        self.may_be_displaced(now);
    }

    fn is_displaced_since(&mut self, since: Stamp) {
        if !self.evidence.is_some_and(|evidence| evidence.is_certain) {
            self.evidence = Some(Evidence { since, is_certain: true, is_track_cut: false });
            self.is_placed_by_scans = false;
        }
    }

    fn may_be_displaced(&mut self, since: Stamp) {
        self.evidence.get_or_insert(Evidence { since, is_certain: false, is_track_cut: false });
    }

    /// Allowed use of a visual pose, `recognised` or tracked.
    pub(crate) fn visual_use(&self, recognised: bool) -> VisualUse {
        match self.evidence {
            Some(evidence) if recognised && evidence.is_certain => VisualUse::Anywhere,
            Some(evidence) if !recognised && evidence.is_track_cut => VisualUse::Nothing,
            _ => VisualUse::Checked,
        }
    }

    /// Records an image. Returns whether the robot is displaced and global localization begins.
    pub(crate) fn add_image(&mut self, now: Stamp, image: ImageEvidence) -> bool {
        if matches!(image, ImageEvidence::Recognised | ImageEvidence::Tracked) {
            self.settle();
            self.is_placed_by_scans = false;
            return false;
        }
        if let Some(evidence) = &mut self.evidence {
            evidence.is_track_cut |= evidence.is_certain || image == ImageEvidence::Unlocated;
        }
        if self.is_placed_by_scans {
            return false;
        }
        let is_elsewhere = match image {
            ImageEvidence::Unlocated => self.add_unlocated(now),
            _ => self.add_blind(now),
        };
        if is_elsewhere {
            self.searched = Some(now);
        }
        is_elsewhere
    }

    fn add_unlocated(&mut self, now: Stamp) -> bool {
        self.unlocated.get_or_insert(now);
        let is_long = |since: Stamp| now - since > DISPLACED_AFTER_S;
        let is_time = self.searched.is_none_or(|searched| now - searched > SEARCH_AGAIN_S);
        is_time && self.unlocated_since().is_some_and(is_long)
    }

    /// Records an image with too few features. After certain evidence it begins one search. It ends a time of unlocated images that was too
    /// short for a search.
    fn add_blind(&mut self, now: Stamp) -> bool {
        if self.unlocated.is_some_and(|since| now - since <= DISPLACED_AFTER_S) {
            self.unlocated = None;
        }
        let is_long =
            |evidence: Evidence| evidence.is_certain && now - evidence.since > BLIND_DISPLACED_AFTER_S;
        self.searched.is_none() && self.evidence.is_some_and(is_long)
    }

    /// Records that scans gave the pose. Unlocated images do not make the pose unknown again until an image is located, or the scans break
    /// again.
    pub(crate) fn localized_by_scans(&mut self) {
        self.settle();
        self.is_placed_by_scans = true;
    }

    /// Whether there is evidence that the robot was carried away.
    pub(crate) fn is_displaced(&self) -> bool {
        self.evidence.is_some()
    }

    /// Whether two successive scans contradict the odometry.
    pub(crate) fn is_certain(&self) -> bool {
        self.evidence.is_some_and(|evidence| evidence.is_certain)
    }

    /// Whether, after evidence of displacement, images with enough features are not located for a short time.
    pub(crate) fn is_doubtful(&self, now: Stamp) -> bool {
        self.unlocated_since().is_some_and(|since| now - since > DOUBTFUL_AFTER_S)
    }

    /// Start of the time without located images, not before the evidence of displacement.
    fn unlocated_since(&self) -> Option<Stamp> {
        Some(self.unlocated?.max(self.evidence?.since))
    }

    /// Ends all evidence: the pose is confirmed.
    pub(crate) fn settle(&mut self) {
        (self.evidence, self.unlocated, self.searched) = (None, None, None);
        self.continuity.settle();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose_monitor::testing::Room;

    /// The times, s, at which the robot counts as displaced; images come every 0.1 s with this `evidence`.
    fn elsewhere(monitor: &mut DisplacementMonitor, evidence: impl Fn(u32) -> ImageEvidence) -> Vec<f64> {
        let time = |i: u32| 0.1 * f64::from(i);
        (0..60)
            .filter(|i| monitor.add_image(Stamp::default().after(time(*i)), evidence(*i)))
            .map(time)
            .collect()
    }

    /// A monitor after scans that show a displacement.
    fn displaced() -> DisplacementMonitor {
        let mut monitor = DisplacementMonitor::default();
        let room = Room::with_corner_box();
        monitor.add_scan(Pose2::IDENTITY, &room.scan(Pose2::IDENTITY, -0.1));
        assert!(!monitor.is_displaced());
        monitor.add_scan(Pose2::IDENTITY, &room.scan(Pose2::new(0.6, 0.3, 0.35), 0.0));
        assert!(monitor.is_displaced());
        monitor
    }

    #[test]
    fn without_evidence_of_displacement_images_that_are_not_located_change_nothing() {
        let mut monitor = DisplacementMonitor::default();
        assert!(elsewhere(&mut monitor, |_| ImageEvidence::Unlocated).is_empty());
        assert_eq!(monitor.unlocated_since(), None);
    }

    #[test]
    fn a_displaced_robot_is_elsewhere_after_a_while_without_a_located_image_and_again() {
        let seconds = elsewhere(&mut displaced(), |_| ImageEvidence::Unlocated);
        assert!((seconds[0] - DISPLACED_AFTER_S).abs() < 0.11, "{seconds:?}");
        let pauses = seconds.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(pauses.into_iter().all(|pause| (pause - SEARCH_AGAIN_S).abs() < 0.11), "{seconds:?}");
        assert_eq!(seconds.len(), 4, "{seconds:?}");
    }

    #[test]
    fn after_a_pause_only_a_recognised_place_ends_it_and_without_one_tracking_does() {
        let mut monitor = displaced();
        assert_eq!(
            (monitor.visual_use(false), monitor.visual_use(true)),
            (VisualUse::Checked, VisualUse::Anywhere)
        );
        monitor.add_image(Stamp::default(), ImageEvidence::Unlocated);
        assert_eq!(
            (monitor.visual_use(false), monitor.visual_use(true)),
            (VisualUse::Nothing, VisualUse::Anywhere)
        );
        monitor.add_image(Stamp::default(), ImageEvidence::Recognised);
        assert!(!monitor.is_displaced());
        let mut through = displaced();
        through.add_image(Stamp::default(), ImageEvidence::Tracked);
        assert!(!through.is_displaced());
    }

    #[test]
    fn the_time_begins_at_the_evidence() {
        let mut monitor = DisplacementMonitor::default();
        for i in 0..50 {
            assert!(!monitor.add_image(Stamp::default().after(0.1 * f64::from(i)), ImageEvidence::Unlocated));
        }
        monitor.add_lift(Stamp::default().after(5.0));
        let at = |time: f64| Stamp::default().after(time);
        assert!(!monitor.add_image(at(5.1), ImageEvidence::Unlocated));
        assert!(monitor.add_image(at(5.9), ImageEvidence::Unlocated));
    }

    #[test]
    fn images_with_features_now_and_then_do_not_begin_one_search_after_the_other() {
        let now_and_then =
            |i: u32| if i.is_multiple_of(2) { ImageEvidence::Unlocated } else { ImageEvidence::Blind };
        assert!(elsewhere(&mut displaced(), now_and_then).len() <= 4);
    }

    #[test]
    fn a_located_image_ends_it() {
        let once = |i: u32| if i == 5 { ImageEvidence::Tracked } else { ImageEvidence::Unlocated };
        assert!(elsewhere(&mut displaced(), once).is_empty());
    }

    #[test]
    fn before_a_bare_wall_a_break_of_the_scans_is_proof_and_a_lift_is_not() {
        let seconds = elsewhere(&mut displaced(), |_| ImageEvidence::Blind);
        assert!(seconds.len() == 1 && (seconds[0] - BLIND_DISPLACED_AFTER_S).abs() < 0.11, "{seconds:?}");
        let mut lifted = DisplacementMonitor::default();
        lifted.add_lift(Stamp::default());
        assert!(elsewhere(&mut lifted, |_| ImageEvidence::Blind).is_empty());
    }

    #[test]
    fn wheels_that_hang_are_evidence() {
        let mut monitor = DisplacementMonitor::default();
        monitor.add_lift(Stamp::default());
        assert!(!elsewhere(&mut monitor, |_| ImageEvidence::Unlocated).is_empty());
    }

    #[test]
    fn a_pose_found_by_scans_holds_until_an_image_is_located_again() {
        let mut monitor = displaced();
        monitor.localized_by_scans();
        monitor.add_lift(Stamp::default());
        assert!(elsewhere(&mut monitor, |_| ImageEvidence::Unlocated).is_empty());
        assert!(!monitor.add_image(Stamp::default(), ImageEvidence::Recognised));
        monitor.add_lift(Stamp::default());
        assert!(!elsewhere(&mut monitor, |_| ImageEvidence::Unlocated).is_empty(), "images count again");
    }

    #[test]
    fn before_a_bare_wall_a_long_time_without_a_located_image_goes_on_and_a_short_one_ends() {
        let since = |unlocated: u32| {
            let mut monitor = DisplacementMonitor::default();
            monitor.add_lift(Stamp::default());
            elsewhere(&mut monitor, |i| {
                if i < unlocated { ImageEvidence::Unlocated } else { ImageEvidence::Blind }
            });
            monitor.unlocated_since()
        };
        assert_eq!((since(5), since(12)), (None, Some(Stamp::default())));
    }
}

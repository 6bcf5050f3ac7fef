//! Whether the robot was carried away: what images, scans and the base show.

use crate::pose_monitor::scan_continuity::{Continuity, ScanContinuity};
use trundle_core::{Pose2, Scan, Stamp};

/// Evidence that the robot stands elsewhere than odometry leads.
///
/// Images that are not located, and scans that contradict the map, are no such evidence: people and moved furniture cause both.
/// Evidence is a break in the sequence of scans, a time without scans, or wheels that hung. It counts until an image is located, or a
/// scan shows again what stood before the break. A break that lasts is proof by itself. The other two are proof only with images that show enough
/// and are not located.
#[derive(Debug, Clone, Default)]
pub(crate) struct DisplacementMonitor {
    continuity: ScanContinuity,
    displaced: Option<Displacement>,
    /// Since when images that count have not been located.
    unlocated: Option<Stamp>,
    /// Stamp at which global localization last began in that time.
    searched: Option<Stamp>,
    /// Whether scans gave the last pose.
    is_placed_by_scans: bool,
}

/// Evidence of displacement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Displacement {
    /// The motion was not measured for a while.
    Possible,
    /// Two successive scans contradict the odometry, since this stamp.
    Certain(Stamp),
}

/// What an image shows of the robot's place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageEvidence {
    /// It was located, at the estimated pose.
    Located,
    /// It has enough features, and was not located.
    Unlocated,
    /// It has too few features to be located.
    Blind,
}

/// Time without a located image \[s\] after which a robot with evidence of displacement is elsewhere. Source: ours.
const DISPLACED_AFTER_S: f64 = 1.5;
/// Time after a certain displacement \[s\] after which a robot whose images show too little to be located is elsewhere. Source: ours,
/// a scan that contradicts the map decides sooner.
const BLIND_DISPLACED_AFTER_S: f64 = 3.0;
/// Time without a located image \[s\] after which an image with few features does not restart the time. Source: ours.
const UNLOCATED_FOR_LONG_S: f64 = 0.7;

impl DisplacementMonitor {
    /// Takes in a scan, taken at `odom_from_base`. Whether odometry does not explain how it follows from the ones before.
    pub(crate) fn add_scan(&mut self, odom_from_base: Pose2, scan: &Scan) -> bool {
        let continuity = self.continuity.add(odom_from_base, scan);
        match continuity {
            Continuity::Continuous => {}
            Continuity::Broken => self.is_displaced_since(scan.stamp()),
            Continuity::Unknown => self.may_be_displaced(),
            Continuity::Restored => self.displaced = None,
        }
        matches!(continuity, Continuity::Broken | Continuity::Unknown)
    }

    /// A wheel hangs.
    pub(crate) fn add_lift(&mut self) {
        self.may_be_displaced();
    }

    fn is_displaced_since(&mut self, now: Stamp) {
        if !matches!(self.displaced, Some(Displacement::Certain(_))) {
            self.displaced = Some(Displacement::Certain(now));
        }
    }

    fn may_be_displaced(&mut self) {
        self.displaced.get_or_insert(Displacement::Possible);
    }

    /// Takes in an image. Whether the robot is elsewhere: global localization begins.
    pub(crate) fn add_image(&mut self, now: Stamp, evidence: ImageEvidence) -> bool {
        if evidence == ImageEvidence::Located {
            self.settle();
            self.is_placed_by_scans = false;
            return false;
        }
        if self.is_placed_by_scans {
            return false;
        }
        if evidence == ImageEvidence::Blind {
            return self.add_blind(now);
        }
        let since = *self.unlocated.get_or_insert(now);
        let is_time = now - self.searched.unwrap_or(since) > DISPLACED_AFTER_S;
        let is_elsewhere = is_time && self.is_displaced();
        if is_elsewhere {
            self.searched = Some(now);
        }
        is_elsewhere
    }

    /// Takes in an image that cannot be located: after a certain displacement it begins one search.
    fn add_blind(&mut self, now: Stamp) -> bool {
        if self.unlocated.is_some_and(|since| now - since <= UNLOCATED_FOR_LONG_S) {
            (self.unlocated, self.searched) = (None, None);
        }
        let is_elsewhere = self.searched.is_none()
            && matches!(self.displaced, Some(Displacement::Certain(since)) if now - since > BLIND_DISPLACED_AFTER_S);
        if is_elsewhere {
            self.searched = Some(now);
        }
        is_elsewhere
    }

    /// Scans gave the pose. Images that are not located do not make it unknown again until one is located.
    pub(crate) fn localized_by_scans(&mut self) {
        self.settle();
        self.is_placed_by_scans = true;
    }

    /// Whether there is evidence that the robot was carried away.
    pub(crate) fn is_displaced(&self) -> bool {
        self.displaced.is_some()
    }

    /// Since when images that show enough have not been located, while there is evidence that the robot was carried away.
    pub(crate) fn unlocated_since(&self) -> Option<Stamp> {
        self.unlocated.filter(|_| self.is_displaced())
    }

    fn settle(&mut self) {
        (self.displaced, self.unlocated, self.searched) = (None, None, None);
        self.continuity.settle();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose_monitor::testing::Room;

    /// The seconds at which the robot counts as elsewhere; images come every 0.1 s, and show what `evidence` says.
    fn elsewhere(monitor: &mut DisplacementMonitor, evidence: impl Fn(u32) -> ImageEvidence) -> Vec<f64> {
        let time = |i: u32| 0.1 * f64::from(i);
        (0..60)
            .filter(|i| monitor.add_image(Stamp::default().after(time(*i)), evidence(*i)))
            .map(time)
            .collect()
    }

    /// A monitor whose scans show that the robot was put elsewhere.
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
        assert_eq!(seconds.len(), 3, "{seconds:?}");
        let pauses = seconds.windows(2).map(|pair| pair[1] - pair[0]).chain([seconds[0]]);
        assert!(pauses.into_iter().all(|pause| (pause - DISPLACED_AFTER_S).abs() < 0.11), "{seconds:?}");
    }

    #[test]
    fn a_located_image_ends_it() {
        let once = |i: u32| if i == 5 { ImageEvidence::Located } else { ImageEvidence::Unlocated };
        assert!(elsewhere(&mut displaced(), once).is_empty());
    }

    #[test]
    fn before_a_bare_wall_a_break_of_the_scans_is_proof_and_a_lift_is_not() {
        let seconds = elsewhere(&mut displaced(), |_| ImageEvidence::Blind);
        assert!(seconds.len() == 1 && (seconds[0] - BLIND_DISPLACED_AFTER_S).abs() < 0.11, "{seconds:?}");
        let mut lifted = DisplacementMonitor::default();
        lifted.add_lift();
        assert!(elsewhere(&mut lifted, |_| ImageEvidence::Blind).is_empty());
    }

    #[test]
    fn wheels_that_hang_are_evidence() {
        let mut monitor = DisplacementMonitor::default();
        monitor.add_lift();
        assert!(!elsewhere(&mut monitor, |_| ImageEvidence::Unlocated).is_empty());
    }

    #[test]
    fn a_pose_found_by_scans_holds_until_an_image_is_located_again() {
        let mut monitor = displaced();
        monitor.localized_by_scans();
        monitor.add_lift();
        assert!(elsewhere(&mut monitor, |_| ImageEvidence::Unlocated).is_empty());
        assert!(!monitor.add_image(Stamp::default(), ImageEvidence::Located));
        monitor.add_lift();
        assert!(!elsewhere(&mut monitor, |_| ImageEvidence::Unlocated).is_empty(), "images count again");
    }

    #[test]
    fn before_a_bare_wall_a_long_time_without_a_located_image_goes_on_and_a_short_one_ends() {
        let since = |unlocated: u32| {
            let mut monitor = DisplacementMonitor::default();
            monitor.add_lift();
            elsewhere(&mut monitor, |i| {
                if i < unlocated { ImageEvidence::Unlocated } else { ImageEvidence::Blind }
            });
            monitor.unlocated_since()
        };
        assert_eq!((since(5), since(12)), (None, Some(Stamp::default())));
    }
}

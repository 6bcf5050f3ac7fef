//! Camera health: a frozen camera, and the stamp of the last scan with content.

use trundle_core::{Beam, Pose2, RgbdImage, Scan, Stamp};

/// Distinguishes images with content from those of a covered or frozen camera, or without depth.
#[derive(Debug, Default)]
pub(crate) struct CameraHealth {
    last: Option<FirstIdentical>,
    /// Stamp of the newest scan with content.
    seen: Option<Stamp>,
}

/// The first of a series of identical images.
#[derive(Debug, Clone, Copy)]
struct FirstIdentical {
    print: u64,
    stamp: Stamp,
    odom_from_base: Pose2,
}

/// Longest time of identical images at rest \[s\]: the noise of a working camera makes images differ. Source: ours.
const MAX_IDENTICAL_IMAGES_S: f64 = 1.0;
/// Motion above which the robot has moved \[m, rad\]. Source: ours.
const MOTION_THRESHOLD: f64 = 0.01;
/// Share of bearings with a measurement below which a scan is empty. Source: ours.
const MIN_SEEN_SHARE: f64 = 0.05;

impl CameraHealth {
    /// Whether this image, taken at `odom_from_base`, is bit-identical to the last ones although the robot has moved or a long time has
    /// passed. The noise of a real camera makes any two images differ.
    pub(crate) fn is_frozen(&mut self, image: &RgbdImage, odom_from_base: Pose2) -> bool {
        let now = FirstIdentical { print: fingerprint(image), stamp: image.stamp(), odom_from_base };
        let Some(first) = self.last.filter(|first| first.print == now.print) else {
            self.last = Some(now);
            return false;
        };
        let motion = first.odom_from_base.inverse() * odom_from_base;
        let has_moved = motion.position().norm() > MOTION_THRESHOLD || motion.theta.abs() > MOTION_THRESHOLD;
        has_moved || now.stamp - first.stamp > MAX_IDENTICAL_IMAGES_S
    }

    /// Records a scan of an image that is not frozen. Returns whether it has content.
    pub(crate) fn note(&mut self, scan: &Scan) -> bool {
        let seen = scan.beams().iter().filter(|beam| **beam != Beam::Unseen).count();
        let shows = seen as f64 >= MIN_SEEN_SHARE * scan.beams().len() as f64 && seen > 0;
        if shows {
            self.seen = self.seen.max(Some(scan.stamp()));
        }
        shows
    }

    /// Stamp of the newest scan with content.
    pub(crate) fn seen(&self) -> Option<Stamp> {
        self.seen
    }
}

/// FNV-1a over the depth and every 16th byte of the colour image.
fn fingerprint(image: &RgbdImage) -> u64 {
    let fold = |hash: u64, word: u64| (hash ^ word).wrapping_mul(0x0100_0000_01b3);
    let depth =
        image.depth().data().iter().fold(0xcbf2_9ce4_8422_2325, |h, d| fold(h, u64::from(d.to_bits())));
    image.color().data().iter().step_by(16).fold(depth, |h, rgb| fold(h, u64::from(rgb[1])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{DepthImage, Image, Vector2};

    fn image(depth: f32) -> RgbdImage {
        image_at(0.0, depth)
    }

    fn image_at(time: f64, depth: f32) -> RgbdImage {
        RgbdImage::new(
            Stamp::default().after(time),
            Image::filled(8, 4, [9; 3]),
            DepthImage::filled(8, 4, depth),
        )
        .unwrap()
    }

    #[test]
    fn an_image_that_stays_while_the_robot_moves_is_frozen() {
        let mut camera_health = CameraHealth::default();
        let at = |x: f64| Pose2::new(x, 0.0, 0.0);
        assert!(!camera_health.is_frozen(&image(1.0), at(0.0)));
        assert!(!camera_health.is_frozen(&image(1.0), at(0.0)), "standing still it may well be the same");
        assert!(camera_health.is_frozen(&image(1.0), at(0.1)));
        assert!(!camera_health.is_frozen(&image(1.1), at(0.2)));
    }

    #[test]
    fn a_camera_that_repeats_its_image_for_seconds_is_frozen_even_at_rest() {
        let mut camera_health = CameraHealth::default();
        let frozen = |camera_health: &mut CameraHealth, time| {
            camera_health.is_frozen(&image_at(time, 1.0), Pose2::IDENTITY)
        };
        assert!(
            !frozen(&mut camera_health, 0.0)
                && !frozen(&mut camera_health, 0.9)
                && frozen(&mut camera_health, 1.1)
        );
        assert!(!camera_health.is_frozen(&image_at(1.2, 1.1), Pose2::IDENTITY), "it goes on");
    }

    #[test]
    fn a_scan_of_nothing_is_not_sight() {
        let mut camera_health = CameraHealth::default();
        let scan =
            |beam, ms| Scan::new(Stamp::from_nanos(ms), Vector2::zeros(), 0.0, 0.1, vec![beam; 20]).unwrap();
        camera_health.note(&scan(Beam::Free { range: 2.0 }, 1));
        camera_health.note(&scan(Beam::Unseen, 2));
        assert_eq!(camera_health.seen(), Some(Stamp::from_nanos(1)));
    }
}

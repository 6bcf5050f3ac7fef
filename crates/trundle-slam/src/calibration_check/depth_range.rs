//! Whether depths are where a depth camera measures.

use crate::calibration_check::issue::CalibrationIssue;
use crate::frame::depth::DepthConfig;
use trundle_core::DepthImage;

/// Images that are checked: 16. Source: ours.
const CHECKED_IMAGES: usize = 16;
/// Distance between the pixels that are checked, in both directions: 8 px. Source: ours.
const STRIDE_PX: usize = 8;
/// Fraction of the depths outside the camera's range beyond which the depth scale is wrong: 0.05. Source: ours.
const MAX_OUTSIDE_RATIO: f64 = 0.05;
/// Factor of the camera's largest depth up to which depths count as in range: 1.5. Some cameras measure a little farther than
/// specified. Source: ours.
const RANGE_MARGIN: f64 = 1.5;
/// Fewest depths for a decision: 200. Source: ours.
const MIN_DEPTHS: usize = 200;

/// Whether depths are where a depth camera measures.
#[derive(Debug, Clone, Default)]
pub(crate) struct DepthRange {
    images: usize,
    depths: Vec<f32>,
}

impl DepthRange {
    /// Records an image; evaluates after [`CHECKED_IMAGES`].
    pub fn record(&mut self, image: &DepthImage, config: &DepthConfig) -> Option<CalibrationIssue> {
        if self.images == CHECKED_IMAGES {
            return None;
        }
        self.images += 1;
        for row in (0..image.height()).step_by(STRIDE_PX).map(|y| image.row(y)) {
            self.depths.extend(row.iter().step_by(STRIDE_PX).filter(|d| d.is_finite() && **d > 0.0));
        }
        if self.images < CHECKED_IMAGES {
            return None;
        }
        let suspicion = self.judge(config);
        self.depths = Vec::new();
        suspicion
    }

    fn judge(&mut self, config: &DepthConfig) -> Option<CalibrationIssue> {
        if self.depths.is_empty() {
            return Some(CalibrationIssue::NoDepth);
        }
        if self.depths.len() < MIN_DEPTHS {
            return None;
        }
        self.depths.sort_unstable_by(f32::total_cmp);
        let all = self.depths.len();
        let below = |limit: f64| self.depths.partition_point(|d| f64::from(*d) < limit) as f64 / all as f64;
        let median = f64::from(self.depths[all / 2]);
        let (near, far) = (below(config.nearest), 1.0 - below(RANGE_MARGIN * config.farthest));
        if near > MAX_OUTSIDE_RATIO {
            return Some(CalibrationIssue::DepthRange { part: near, beyond: false, median });
        }
        (far > MAX_OUTSIDE_RATIO).then_some(CalibrationIssue::DepthRange { part: far, beyond: true, median })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(depth: impl Fn(usize, usize) -> f32) -> Option<CalibrationIssue> {
        let mut check = DepthRange::default();
        let image = DepthImage::from_fn(320, 240, depth);
        (0..2 * CHECKED_IMAGES).find_map(|_| check.record(&image, &DepthConfig::default()))
    }

    #[test]
    fn a_scale_off_by_five_is_noticed_either_way_and_the_right_one_is_not() {
        let room = |x: usize, y: usize| 0.6 + 4.0 * (x + y) as f32 / 560.0;
        assert_eq!(verdict(room), None);
        assert_eq!(verdict(|_, _| 0.0), Some(CalibrationIssue::NoDepth));
        assert_eq!(verdict(|_, _| f32::NAN), Some(CalibrationIssue::NoDepth));
        let far = verdict(|x, y| 5.0 * room(x, y)).unwrap();
        assert!(matches!(far, CalibrationIssue::DepthRange { beyond: true, .. }), "{far}");
        let near = verdict(|x, y| 0.2 * room(x, y)).unwrap();
        assert!(matches!(near, CalibrationIssue::DepthRange { beyond: false, .. }), "{near}");
    }
}

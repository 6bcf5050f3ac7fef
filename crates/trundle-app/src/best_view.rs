//! The image with the largest number of tracked features, for the report.

use std::collections::VecDeque;
use trundle_core::{RgbdImage, Stamp};
use trundle_io::EncodedRgbd;
use trundle_runtime::{Robot, StepReport};
use trundle_slam::SeenFeature;

/// The image in which the largest number of features was tracked, for the report.
#[derive(Debug, Default)]
pub struct BestView {
    /// Images that tracking has not used.
    waiting: VecDeque<EncodedRgbd>,
    best: Option<EncodedRgbd>,
    /// Features of the image.
    pub features: Vec<SeenFeature>,
    inliers: usize,
}

impl BestView {
    /// Keeps an image that reached the robot.
    pub fn on_image(&mut self, image: &EncodedRgbd) {
        self.waiting.push_back(image.clone());
    }

    /// Keeps the image of `stamp`, which was tracked, if it has more tracked features than the best one.
    pub fn on_tracked(&mut self, stamp: Stamp, robot: &Robot, report: &StepReport) {
        let before = self.waiting.iter().take_while(|image| image.stamp != stamp).count();
        self.waiting.drain(..before);
        let Some(image) = self.waiting.pop_front() else { return };
        let inliers = report.track.as_ref().map_or(0, |track| track.inliers);
        if self.best.is_none() || inliers > self.inliers {
            self.best = Some(image);
            self.inliers = inliers;
            self.features = robot.slam().map_or_else(Vec::new, |slam| slam.last_features());
        }
    }

    /// The image; `None` before the first one.
    pub fn image(&self) -> Option<RgbdImage> {
        self.best.as_ref()?.decode().ok()
    }
}

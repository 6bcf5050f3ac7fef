use std::collections::VecDeque;
use trundle::core::{RgbdImage, Stamp};
use trundle::io::EncodedRgbd;
use trundle::runtime::{Robot, StepReport};
use trundle::slam::SeenFeature;

/// The image in which the most features were tracked, for the report.
#[derive(Debug, Default)]
pub struct BestView {
    /// Images that nobody has looked at yet.
    waiting: VecDeque<EncodedRgbd>,
    best: Option<EncodedRgbd>,
    /// Its features.
    pub features: Vec<SeenFeature>,
    inliers: usize,
}

impl BestView {
    /// Notes an image that the robot got.
    pub fn arrived(&mut self, image: &EncodedRgbd) {
        self.waiting.push_back(image.clone());
    }

    /// What the robot says of the image of `stamp`: kept if it shows more than the one before.
    pub fn looked_at(&mut self, stamp: Stamp, robot: &Robot, report: &StepReport) {
        let before = self.waiting.iter().take_while(|image| image.stamp != stamp).count();
        self.waiting.drain(..before);
        let Some(image) = self.waiting.pop_front() else { return };
        let inliers = report.track.as_ref().map_or(0, |track| track.inliers);
        if self.best.is_none() || inliers > self.inliers {
            self.best = Some(image);
            self.inliers = inliers;
            self.features = robot.slam().map_or_else(Vec::new, |slam| slam.last_features().to_vec());
        }
    }

    /// The image, if there was any.
    pub fn image(&self) -> Option<RgbdImage> {
        self.best.as_ref()?.decode().ok()
    }
}

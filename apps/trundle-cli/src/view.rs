use trundle::core::RgbdImage;
use trundle::runtime::{Robot, StepReport};
use trundle::slam::SeenFeature;

/// The image in which the most features were tracked, for the report.
#[derive(Debug, Default)]
pub struct BestView {
    /// The image, if there was any.
    pub image: Option<RgbdImage>,
    /// Its features.
    pub features: Vec<SeenFeature>,
    inliers: usize,
}

impl BestView {
    /// Keeps the image if it shows more than the one before.
    pub fn offer(&mut self, image: RgbdImage, robot: &Robot, report: &StepReport) {
        let inliers = report.track.as_ref().map_or(0, |track| track.inliers);
        if self.image.is_none() || inliers > self.inliers {
            self.image = Some(image);
            self.inliers = inliers;
            self.features = robot.slam().last_features().to_vec();
        }
    }
}

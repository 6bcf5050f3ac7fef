//! From an image to a frame.

use crate::config::SlamConfig;
use crate::frame::depth::DepthConfig;
use crate::frame::observation_model::ObservationModel;
use crate::frame::reduction::Reduction;
use crate::frame::rgbd_frame::Frame;
use std::borrow::Cow;
use trundle_core::{
    DepthImage, GrayImage, Invalid, PinholeCamera, RgbdImage, Stamp, Vector3, gray_from_color,
};
use trundle_vision::{Features, OrbExtractor};

/// The camera and the feature extractor.
#[derive(Debug)]
pub(crate) struct FrontEnd {
    pub model: ObservationModel,
    /// Reduction of the images to those of `model`.
    pub reduction: Reduction,
    extractor: OrbExtractor,
    /// Reused buffers for the features of the next image: half a megabyte.
    spare: Features,
}

impl FrontEnd {
    /// # Errors
    /// When the settings are invalid.
    pub fn new(camera: PinholeCamera, config: &SlamConfig) -> Result<Self, Invalid> {
        let extractor = OrbExtractor::new(config.orb.clone())?;
        let reduction = Reduction::of(&camera, config.max_side_px);
        let scales = extractor.scale_factors().to_vec();
        let model = ObservationModel::new(reduction.camera(camera)?, scales, config.tracking.pixel_sigma);
        Ok(Self { model, reduction, extractor, spare: Features::default() })
    }

    /// The grey image and the depth image at the size at which they are tracked.
    pub fn reduced<'a>(&self, image: &'a RgbdImage) -> (GrayImage, Cow<'a, DepthImage>) {
        (self.reduction.gray(gray_from_color(image.color())), self.reduction.depth(image.depth()))
    }

    /// The features of an image; empty if the image size differs from the camera's.
    pub fn extract(&mut self, gray: &GrayImage) -> Features {
        let camera = &self.model.camera;
        if gray.width() != camera.width() || gray.height() != camera.height() {
            return Features::default();
        }
        let mut features = std::mem::take(&mut self.spare);
        self.extractor.extract_into(gray, &mut features);
        features
    }

    /// The frame of an image during which the camera turned at `turn_rate` (rad/s, camera frame).
    pub fn frame(
        &self,
        stamp: Stamp,
        features: Features,
        depth: &DepthImage,
        turn_rate: Vector3,
        config: &DepthConfig,
    ) -> Frame {
        let turn = turn_rate * self.model.camera.readout();
        Frame::new(stamp, features, depth, turn, (&self.model, config))
    }

    /// Keeps the buffers of a frame for reuse.
    pub fn reuse(&mut self, frame: Frame) {
        self.spare = frame.features;
    }
}

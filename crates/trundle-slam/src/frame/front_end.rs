//! From an image to a frame.

use crate::frame::depth::DepthConfig;
use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use trundle_core::{DepthImage, GrayImage, Invalid, PinholeCamera, Stamp, Vector3};
use trundle_vision::{Features, OrbConfig, OrbExtractor};

/// The camera and the feature extractor.
#[derive(Debug)]
pub(crate) struct FrontEnd {
    pub model: ObservationModel,
    extractor: OrbExtractor,
    /// Reused buffers for the features of the next image: half a megabyte.
    spare: Features,
}

impl FrontEnd {
    /// # Errors
    /// When the settings are invalid.
    pub fn new(camera: PinholeCamera, orb: &OrbConfig, pixel_sigma: f64) -> Result<Self, Invalid> {
        let extractor = OrbExtractor::new(orb.clone())?;
        let model = ObservationModel::new(camera, extractor.scale_factors().to_vec(), pixel_sigma);
        Ok(Self { model, extractor, spare: Features::default() })
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

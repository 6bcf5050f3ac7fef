//! The stored part of one image: features, their rectified positions and their depths.

use crate::frame::aligned_feature::{Aligned, raw};
use crate::frame::depth::{DepthConfig, MAX_RELATIVE_SIGMA};
use crate::frame::depth_edges::drop_depth_edges;
use crate::frame::observation_model::ObservationModel;
use crate::median::median;
use nalgebra::UnitQuaternion;
use trundle_core::{DepthImage, PinholeCamera, Stamp, Vector2, Vector3};
use trundle_optim::{InverseDepth, PointObservation};
use trundle_vision::{Descriptor, FeatureGrid, Features, Keypoint};

/// Standard deviation below which a feature counts as aligned, as a fraction of that of an unaligned feature: 0.99. Source: ours.
const ALIGNED_SIGMA_RATIO: f64 = 0.99;

/// The stored part of one image: features, their positions in the rectified image, and their depths.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    pub stamp: Stamp,
    pub features: Features,
    /// Rectified position of each feature, px.
    pub pixels: Vec<Vector2>,
    /// Inverse depth of each feature, read at its raw pixel.
    pub depths: Vec<Option<InverseDepth>>,
    /// Standard deviation of either coordinate of each feature's place, px.
    pub pixel_sigmas: Vec<f32>,
    /// Gradient of the inverse depth around each feature, 1/(m px), right and down; empty for a keyframe.
    pub slopes: Vec<Vector2>,
    grid: FeatureGrid,
}

impl Frame {
    /// A frame of an image during which the camera turned by `turn` (rad, camera frame) from the first row to the last. Features get the
    /// positions that they would have if all rows were taken at the time of the middle row. Features on depth edges are dropped.
    pub fn new(
        stamp: Stamp,
        mut features: Features,
        image: &DepthImage,
        turn: Vector3,
        (model, depth): (&ObservationModel, &DepthConfig),
    ) -> Self {
        drop_depth_edges(&mut features, image, |octave| model.scale(octave), depth);
        let depths = features.keypoints.iter().map(|k| depth.measure(image, raw(k))).collect();
        let slope = |k: &Keypoint| depth.slope(image, raw(k), model.scale(k.octave));
        let slopes = match features.patches.is_empty() {
            true => vec![],
            false => features.keypoints.iter().map(slope).collect(),
        };
        if turn != Vector3::zeros() {
            features.keypoints.iter_mut().for_each(|k| correct_rolling_shutter(k, turn, model));
        }
        Self { slopes, ..Self::of(stamp, features, depths, model) }
    }

    /// A frame of features with these inverse depths.
    pub fn of(
        stamp: Stamp,
        features: Features,
        depths: Vec<Option<InverseDepth>>,
        model: &ObservationModel,
    ) -> Self {
        let pixels: Vec<Vector2> = features.keypoints.iter().map(|k| rectified(k, model)).collect();
        let grid = grid(&features, &pixels, model);
        Self { stamp, features, pixels, depths, pixel_sigmas: vec![], slopes: vec![], grid }.unaligned(model)
    }

    /// This frame with the features at their aligned positions.
    #[must_use]
    pub fn with_aligned(
        mut self,
        aligned: impl Iterator<Item = (usize, Aligned)>,
        model: &ObservationModel,
    ) -> Self {
        for (i, Aligned { raw, sigma, .. }) in aligned {
            let keypoint = &mut self.features.keypoints[i];
            (keypoint.x, keypoint.y) = (raw.x as f32, raw.y as f32);
            self.pixels[i] = rectified(keypoint, model);
            self.pixel_sigmas[i] = sigma as f32;
        }
        self.grid = grid(&self.features, &self.pixels, model);
        self
    }

    /// This frame with the standard deviation of an unaligned feature for all features.
    #[must_use]
    pub fn unaligned(mut self, model: &ObservationModel) -> Self {
        let sigmas = self.features.keypoints.iter().map(|k| model.sigma_of(k.octave) as f32);
        self.pixel_sigmas = sigmas.collect();
        self
    }

    /// Median standard deviation of the aligned features, px of their octaves; that of an unaligned feature if none is aligned.
    pub fn median_aligned_sigma_px(&self, model: &ObservationModel) -> f64 {
        let in_octave = |(k, sigma): (&Keypoint, &f32)| f64::from(*sigma) / model.scale(k.octave);
        let sigmas = self.features.keypoints.iter().zip(&self.pixel_sigmas).map(in_octave);
        median(sigmas.filter(|sigma| *sigma < ALIGNED_SIGMA_RATIO * model.pixel_sigma))
            .unwrap_or(model.pixel_sigma)
    }

    /// Frees the data that only the current frame needs.
    pub fn drop_image(&mut self) {
        (self.features.patches, self.slopes) = (vec![], vec![]);
    }

    /// Number of features.
    pub fn len(&self) -> usize {
        self.pixels.len()
    }

    /// The observation of feature `i`.
    pub fn observation(&self, i: usize) -> PointObservation {
        PointObservation {
            pixel: self.pixels[i],
            pixel_sigma: f64::from(self.pixel_sigmas[i]),
            depth: self.depths[i],
        }
    }

    /// Observation of a feature with the standard deviation of an unaligned one, to test matches with landmarks other than the one of its
    /// alignment.
    pub fn unaligned_observation(&self, i: usize, model: &ObservationModel) -> PointObservation {
        PointObservation { pixel_sigma: model.sigma_of(self.octave(i)), ..self.observation(i) }
    }

    /// Position of feature `i` by its own depth, camera frame, m.
    pub fn point(&self, i: usize, model: &ObservationModel) -> Option<Vector3> {
        self.depths[i].map(|depth| model.camera.unproject(self.pixels[i], 1.0 / depth.value))
    }

    pub fn octave(&self, i: usize) -> u8 {
        self.features.keypoints[i].octave
    }

    pub fn descriptor(&self, i: usize) -> &Descriptor {
        &self.features.descriptors[i]
    }

    /// The features within `radius` px of a rectified `pixel`, of the given octaves.
    pub fn near(&self, pixel: Vector2, radius: f64, octaves: (u8, u8)) -> impl Iterator<Item = usize> + '_ {
        self.grid.near(pixel.x as f32, pixel.y as f32, radius as f32, octaves.0..=octaves.1)
    }
}

/// Moves a feature to its position in an image taken at the time of the middle row. Only rotation is corrected: translation during the
/// readout is small.
fn correct_rolling_shutter(keypoint: &mut Keypoint, turn: Vector3, model: &ObservationModel) {
    let camera = &model.camera;
    let late = row_fraction(keypoint, camera);
    let ray = camera.unproject(rectified(keypoint, model), 1.0);
    let turned = UnitQuaternion::from_scaled_axis(turn * late) * ray;
    if let Some(pixel) = camera.project(turned) {
        let moved = camera.distort(pixel);
        (keypoint.x, keypoint.y) = (moved.x as f32, moved.y as f32);
    }
}

/// Row of a keypoint as a fraction of the height from the middle row, -0.5 to 0.5.
pub(crate) fn row_fraction(keypoint: &Keypoint, camera: &PinholeCamera) -> f64 {
    f64::from(keypoint.y) / (camera.height() as f64 - 1.0) - 0.5
}

/// Position of a keypoint without lens distortion, px.
fn rectified(keypoint: &Keypoint, model: &ObservationModel) -> Vector2 {
    model.camera.undistort(raw(keypoint))
}

fn grid(features: &Features, pixels: &[Vector2], model: &ObservationModel) -> FeatureGrid {
    let at = |(k, p): (&Keypoint, &Vector2)| Keypoint { x: p.x as f32, y: p.y as f32, ..*k };
    let keypoints: Vec<Keypoint> = features.keypoints.iter().zip(pixels).map(at).collect();
    FeatureGrid::new(&keypoints, model.camera.width(), model.camera.height())
}

/// The features whose depth is certain enough for a landmark.
pub(crate) fn with_depth(frame: &Frame) -> impl Iterator<Item = usize> + '_ {
    let good = |i: &usize| frame.depths[*i].is_some_and(|d| d.sigma <= MAX_RELATIVE_SIGMA * d.value);
    (0..frame.len()).filter(good)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::model;

    #[test]
    fn a_rolling_shutter_is_corrected() {
        let (model, turn) = (model(), Vector3::new(0.01, 0.04, -0.02));
        let image = DepthImage::filled(320, 240, 2.0);
        let mut features = Features::default();
        let mut still = Vec::new();
        for (x, y) in [(-0.4, -0.3), (0.0, 0.0), (0.3, 0.25), (0.1, -0.28)] {
            let ray = Vector3::new(x, y, 1.0);
            let mut row = 120.0;
            // The point moves while its row is read: iterate to the row of its appearance.
            let mut pixel = Vector2::zeros();
            for _ in 0..9 {
                let turned = UnitQuaternion::from_scaled_axis(turn * (row / 239.0 - 0.5)).inverse() * ray;
                pixel = model.camera.project(turned).unwrap();
                row = pixel.y;
            }
            let (x, y) = (pixel.x as f32, pixel.y as f32);
            features.keypoints.push(Keypoint { x, y, octave: 0, angle: 0.0, response: 1.0 });
            features.descriptors.push(Descriptor::default());
            still.push(model.camera.project(ray).unwrap());
        }
        let frame = Frame::new(Stamp::default(), features, &image, turn, (&model, &DepthConfig::default()));
        for (found, truth) in frame.pixels.iter().zip(&still) {
            assert!((found - truth).norm() < 1e-3, "{found} is not {truth}");
        }
    }
}

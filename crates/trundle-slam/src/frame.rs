use crate::align::Aligned;
use crate::depth::DepthConfig;
use crate::median::median;
use crate::outline::drop_outlines;
use crate::sensor::Sensor;
use nalgebra::UnitQuaternion;
use trundle_core::{DepthImage, Stamp, Vector2, Vector3};
use trundle_optim::InverseDepth;
use trundle_vision::{Descriptor, FeatureGrid, Features, Keypoint};

/// What is placed better than this part of the standard deviation of a feature was aligned.
const ALIGNED: f64 = 0.99;

/// What is kept of one image: features, where they are in the rectified image, and how far.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    pub stamp: Stamp,
    pub features: Features,
    /// Rectified position of each feature, px.
    pub pixels: Vec<Vector2>,
    /// Inverse depth of each feature, looked up at its raw pixel.
    pub depths: Vec<Option<InverseDepth>>,
    /// Standard deviation of either coordinate of each feature's place, px.
    pub pixel_sigmas: Vec<f32>,
    /// How the inverse depth rises around each feature, 1/(m px), right and down; of a frame that was kept, nothing.
    pub slopes: Vec<Vector2>,
    grid: FeatureGrid,
}

impl Frame {
    /// Of an image during which the camera turned by `turn` (rad, camera frame) from its first row to its last: features
    /// are kept where they would be had all rows been taken with the middle one, but for those on outlines, which are dropped.
    pub fn new(
        stamp: Stamp,
        mut features: Features,
        image: &DepthImage,
        turn: Vector3,
        (sensor, depth): (&Sensor, &DepthConfig),
    ) -> Self {
        drop_outlines(&mut features, image, |octave| sensor.scale(octave), depth);
        let depths = features.keypoints.iter().map(|k| depth.measure(image, raw(k))).collect();
        let slope = |k: &Keypoint| depth.slope(image, raw(k), sensor.scale(k.octave));
        let slopes = match features.patches.is_empty() {
            true => vec![],
            false => features.keypoints.iter().map(slope).collect(),
        };
        if turn != Vector3::zeros() {
            features.keypoints.iter_mut().for_each(|k| unroll(k, turn, sensor));
        }
        Self { slopes, ..Self::of(stamp, features, depths, sensor) }
    }

    /// Of features with their inverse depths.
    pub fn of(stamp: Stamp, features: Features, depths: Vec<Option<InverseDepth>>, sensor: &Sensor) -> Self {
        let pixels: Vec<Vector2> = features.keypoints.iter().map(|k| rectified(k, sensor)).collect();
        let grid = grid(&features, &pixels, sensor);
        Self { stamp, features, pixels, depths, pixel_sigmas: vec![], slopes: vec![], grid }.unaligned(sensor)
    }

    /// The same with features where they were aligned to.
    #[must_use]
    pub fn with_aligned(mut self, aligned: impl Iterator<Item = (usize, Aligned)>, sensor: &Sensor) -> Self {
        for (i, Aligned { raw, sigma, .. }) in aligned {
            let keypoint = &mut self.features.keypoints[i];
            (keypoint.x, keypoint.y) = (raw.x as f32, raw.y as f32);
            self.pixels[i] = rectified(keypoint, sensor);
            self.pixel_sigmas[i] = sigma as f32;
        }
        self.grid = grid(&self.features, &self.pixels, sensor);
        self
    }

    /// The same with all features as uncertain as plain ones.
    #[must_use]
    pub fn unaligned(mut self, sensor: &Sensor) -> Self {
        let sigmas = self.features.keypoints.iter().map(|k| sensor.sigma_of(k.octave) as f32);
        self.pixel_sigmas = sigmas.collect();
        self
    }

    /// Standard deviation of its aligned features, the median of them, px of their octaves; that of a plain one where there are none.
    pub fn sharpness(&self, sensor: &Sensor) -> f64 {
        let in_octave = |(k, sigma): (&Keypoint, &f32)| f64::from(*sigma) / sensor.scale(k.octave);
        let sigmas = self.features.keypoints.iter().zip(&self.pixel_sigmas).map(in_octave);
        median(sigmas.filter(|sigma| *sigma < ALIGNED * sensor.pixel_sigma)).unwrap_or(sensor.pixel_sigma)
    }

    /// Lets go what only a frame at hand needs.
    pub fn forget_image(&mut self) {
        (self.features.patches, self.slopes) = (vec![], vec![]);
    }

    /// How many features it has.
    pub fn len(&self) -> usize {
        self.pixels.len()
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

/// Moves a feature to where the middle row's camera would have seen it, as a direction: what is not far is off by the way
/// the camera went meanwhile, which is little.
fn unroll(keypoint: &mut Keypoint, turn: Vector3, sensor: &Sensor) {
    let camera = &sensor.camera;
    let late = f64::from(keypoint.y) / (camera.height() as f64 - 1.0) - 0.5;
    let ray = camera.unproject(rectified(keypoint, sensor), 1.0);
    let turned = UnitQuaternion::from_scaled_axis(turn * late) * ray;
    if let Some(pixel) = camera.project(turned) {
        let moved = camera.distort(pixel);
        (keypoint.x, keypoint.y) = (moved.x as f32, moved.y as f32);
    }
}

/// Where a keypoint would be without the lens, px.
fn rectified(keypoint: &Keypoint, sensor: &Sensor) -> Vector2 {
    sensor.camera.undistort(raw(keypoint))
}

fn grid(features: &Features, pixels: &[Vector2], sensor: &Sensor) -> FeatureGrid {
    let at = |(k, p): (&Keypoint, &Vector2)| Keypoint { x: p.x as f32, y: p.y as f32, ..*k };
    let keypoints: Vec<Keypoint> = features.keypoints.iter().zip(pixels).map(at).collect();
    FeatureGrid::new(&keypoints, sensor.camera.width(), sensor.camera.height())
}

/// Where the image has a keypoint, px, as the lens bends it.
pub(crate) fn raw(keypoint: &Keypoint) -> Vector2 {
    Vector2::new(f64::from(keypoint.x), f64::from(keypoint.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::sensor;

    #[test]
    fn a_rolling_shutter_is_taken_out() {
        let (sensor, turn) = (sensor(), Vector3::new(0.01, 0.04, -0.02));
        let image = DepthImage::filled(320, 240, 2.0);
        let mut features = Features::default();
        let mut still = Vec::new();
        for (x, y) in [(-0.4, -0.3), (0.0, 0.0), (0.3, 0.25), (0.1, -0.28)] {
            let ray = Vector3::new(x, y, 1.0);
            let mut row = 120.0;
            // Where the row is read at which the point appears.
            let mut pixel = Vector2::zeros();
            for _ in 0..9 {
                let turned = UnitQuaternion::from_scaled_axis(turn * (row / 239.0 - 0.5)).inverse() * ray;
                pixel = sensor.camera.project(turned).unwrap();
                row = pixel.y;
            }
            let (x, y) = (pixel.x as f32, pixel.y as f32);
            features.keypoints.push(Keypoint { x, y, octave: 0, angle: 0.0, response: 1.0 });
            features.descriptors.push(Descriptor::default());
            still.push(sensor.camera.project(ray).unwrap());
        }
        let frame = Frame::new(Stamp::default(), features, &image, turn, (&sensor, &DepthConfig::default()));
        for (found, truth) in frame.pixels.iter().zip(&still) {
            assert!((found - truth).norm() < 1e-3, "{found} is not {truth}");
        }
    }
}

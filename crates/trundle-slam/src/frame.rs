use crate::depth::DepthConfig;
use crate::sensor::Sensor;
use trundle_core::{DepthImage, Stamp, Vector2};
use trundle_optim::InverseDepth;
use trundle_vision::{Descriptor, FeatureGrid, Features, Keypoint};

/// What is kept of one image: features, where they are in the rectified image, and how far.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    pub stamp: Stamp,
    pub features: Features,
    /// Rectified position of each feature, px.
    pub pixels: Vec<Vector2>,
    /// Inverse depth of each feature, looked up at its raw pixel.
    pub depths: Vec<Option<InverseDepth>>,
    grid: FeatureGrid,
}

impl Frame {
    pub fn new(
        stamp: Stamp,
        features: Features,
        image: &DepthImage,
        sensor: &Sensor,
        depth: &DepthConfig,
    ) -> Self {
        let depths = features.keypoints.iter().map(|k| depth.measure(image, raw(k))).collect();
        Self::of(stamp, features, depths, sensor)
    }

    /// Of features with their inverse depths.
    pub fn of(stamp: Stamp, features: Features, depths: Vec<Option<InverseDepth>>, sensor: &Sensor) -> Self {
        let pixels: Vec<Vector2> =
            features.keypoints.iter().map(|k| sensor.camera.undistort(raw(k))).collect();
        let rectified = |(k, p): (&Keypoint, &Vector2)| Keypoint { x: p.x as f32, y: p.y as f32, ..*k };
        let rectified: Vec<Keypoint> = features.keypoints.iter().zip(&pixels).map(rectified).collect();
        let grid = FeatureGrid::new(&rectified, sensor.camera.width(), sensor.camera.height());
        Self { stamp, features, pixels, depths, grid }
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

fn raw(keypoint: &Keypoint) -> Vector2 {
    Vector2::new(f64::from(keypoint.x), f64::from(keypoint.y))
}

//! Observation model of a camera: projection into the rectified image, and standard deviations of keypoints.

use trundle_core::{PinholeCamera, Vector2, Vector3};
use trundle_vision::OrbConfig;

/// The camera of the tracker: projection into the rectified image, and standard deviations of keypoints.
#[derive(Debug, Clone)]
pub(crate) struct ObservationModel {
    pub camera: PinholeCamera,
    /// Size of each octave's pixel, px of the full image.
    pub scale_factors: Vec<f64>,
    /// Standard deviation of a keypoint of octave 0, px.
    pub pixel_sigma: f64,
    /// Corners of the box around the rectified image, px.
    low: Vector2,
    high: Vector2,
}

/// Largest distance of a keypoint from its landmark: 2 standard deviations. Source: ours, 95 % of a normal distribution.
const KEYPOINT_SIGMAS: f64 = 2.0;

impl ObservationModel {
    pub fn new(camera: PinholeCamera, scale_factors: Vec<f64>, pixel_sigma: f64) -> Self {
        let (right, bottom) = (camera.width() as f64 - 1.0, camera.height() as f64 - 1.0);
        let (mut low, mut high) = (Vector2::repeat(f64::MAX), Vector2::repeat(f64::MIN));
        for step in 0..=16 {
            let part = f64::from(step) / 16.0;
            let (x, y) = (part * right, part * bottom);
            for raw in [(x, 0.0), (x, bottom), (0.0, y), (right, y)] {
                let pixel = camera.undistort(Vector2::new(raw.0, raw.1));
                (low, high) = (low.inf(&pixel), high.sup(&pixel));
            }
        }
        Self { camera, scale_factors, pixel_sigma, low, high }
    }

    /// Where a camera-frame point (m) appears: rectified and raw pixel; `None` if it is out of view.
    pub fn project(&self, p_camera: Vector3) -> Option<(Vector2, Vector2)> {
        let pixel = self.camera.project(p_camera)?;
        let boxed = pixel.x >= self.low.x
            && pixel.y >= self.low.y
            && pixel.x <= self.high.x
            && pixel.y <= self.high.y;
        let raw = boxed.then(|| self.camera.distort(pixel))?;
        self.camera.contains(raw).then_some((pixel, raw))
    }

    /// Whether a feature of an octave can be found at a raw `pixel` and within a keypoint's error of it.
    ///
    /// A landmark in the margin of the image could only be matched with a wrong feature farther inward. Such matches would bias the motion
    /// of a turning camera.
    pub fn can_find_at(&self, pixel: Vector2, octave: u8) -> bool {
        let margin = (OrbConfig::MARGIN as f64 + KEYPOINT_SIGMAS * self.pixel_sigma) * self.scale(octave);
        let [right, bottom] =
            [self.camera.width(), self.camera.height()].map(|side| side as f64 - 1.0 - margin);
        (margin..=right).contains(&pixel.x) && (margin..=bottom).contains(&pixel.y)
    }

    /// Standard deviation of a keypoint of `octave` as the extractor finds it, px.
    pub fn sigma_of(&self, octave: u8) -> f64 {
        self.pixel_sigma * self.scale(octave)
    }

    /// The size of a pixel of `octave`, px of the full image.
    pub fn scale(&self, octave: u8) -> f64 {
        self.scale_factors[usize::from(octave).min(self.scale_factors.len() - 1)]
    }

    /// The octave whose pixel size is nearest to `scale`, by ratio.
    pub fn octave_of(&self, scale: f64) -> u8 {
        // Nearer to the coarser one when above their geometric mean.
        self.scale_factors.windows(2).take_while(|pair| scale * scale > pair[0] * pair[1]).count() as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Distortion;

    fn freiburg1() -> ObservationModel {
        let lens = Distortion { k1: 0.2624, k2: -0.9531, p1: -0.0054, p2: 0.0026, k3: 1.1633 };
        let camera = PinholeCamera::new((640, 480), (517.3, 516.5), (318.6, 255.3), lens).unwrap();
        ObservationModel::new(camera, vec![1.0, 1.2, 1.44], 1.0)
    }

    #[test]
    fn no_feature_can_be_found_in_the_margin() {
        let model = freiburg1();
        let finds = |x: f64, octave: u8| model.can_find_at(Vector2::new(x, 240.0), octave);
        assert!(finds(18.5, 0) && !finds(17.5, 0) && finds(620.5, 0) && !finds(621.5, 0));
        assert!(finds(22.0, 1) && !finds(21.0, 1), "the margin is in px of the octave");
        assert!(!model.can_find_at(Vector2::new(320.0, 17.0), 0) && !finds(f64::NAN, 0));
    }

    #[test]
    fn points_are_in_view_where_the_distorted_image_has_them() {
        let model = freiburg1();
        for raw in [(0.0, 0.0), (639.0, 479.0), (320.0, 3.0)] {
            let pixel = model.camera.undistort(Vector2::new(raw.0, raw.1));
            let (found, back) = model.project(model.camera.unproject(pixel, 2.0)).unwrap();
            assert!((found - pixel).norm() < 1e-9 && (back - Vector2::new(raw.0, raw.1)).norm() < 1e-3);
        }
        for off in [Vector3::new(5.0, 0.0, 1.0), Vector3::new(0.0, 0.0, -1.0), Vector3::new(0.0, -1.0, 1.0)] {
            assert_eq!(model.project(off), None);
        }
    }

    #[test]
    fn the_nearest_octave_is_chosen() {
        let model = freiburg1();
        assert_eq!([0.1, 1.05, 1.25, 9.0].map(|s| model.octave_of(s)), [0, 0, 1, 2]);
    }
}

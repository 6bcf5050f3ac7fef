//! Measurement of the depth camera, and its standard deviation.

use nalgebra::Matrix2;
use serde::{Deserialize, Serialize};
use trundle_core::{DepthImage, Hypotenuse, Invalid, Vector2, require_in};
use trundle_optim::InverseDepth;

/// Offsets of the pixels by which the slope of the depth is fitted, px of the octave; each with its mirror image. Source: ours.
const SLOPE_OFFSETS_PX: [(f64, f64); 6] =
    [(5.0, 0.0), (0.0, 5.0), (4.0, 4.0), (4.0, -4.0), (2.5, 0.0), (0.0, 2.5)];
/// Fewest pixel pairs with depth for a fit of the slope: 4. With fewer pairs the slope is 0. Source: ours.
const MIN_SLOPE_PAIRS: usize = 4;
/// Largest relative difference of a depth from the middle one in the fit of the slope: 0.1. Beyond it the pixel is of another
/// surface. Source: ours.
const MAX_SLOPE_DEPTH_RATIO: f64 = 0.1;

/// Largest standard deviation of a depth that makes a point, as a fraction of the depth: 0.1. Source: ours.
pub(crate) const MAX_RELATIVE_SIGMA: f64 = 0.1;

/// Range and noise of the depth camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct DepthConfig {
    /// Nearest usable depth, m, 0.001 to 10. Default 0.3: below it no Kinect measures.
    pub nearest: f64,
    /// Farthest usable depth, m, `nearest` to 100. Default 8: the Kinect V2's range \[Li18\].
    pub farthest: f64,
    /// Standard deviation of a depth that does not grow with range, m, above 0, to 1. Default 0.01: half of the Kinect V2's
    /// 2 cm \[Li18\], and the registration error of a Kinect v1.
    pub sigma: f64,
    /// Part of the standard deviation that grows with the square of the depth, 1/m, 0 or more. Default 0.0025: the
    /// disparity noise of a Kinect v1 (Khoshelham and Elberink 2012, 2.5 cm at 3 m).
    pub sigma_quadratic: f64,
}

impl Default for DepthConfig {
    fn default() -> Self {
        Self { nearest: 0.3, farthest: 8.0, sigma: 0.01, sigma_quadratic: 0.0025 }
    }
}

impl DepthConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("depth.nearest", self.nearest, "m", 0.001, 10.0)?;
        require_in("depth.farthest", self.farthest, "m", self.nearest, 100.0)?;
        require_in("depth.sigma", self.sigma, "m", 1e-6, 1.0)?;
        require_in("depth.sigma_quadratic", self.sigma_quadratic, "1/m", 0.0, 1.0)?;
        Ok(self)
    }

    /// Standard deviation of a measured `depth` (m) on a smooth surface, m.
    pub fn sigma_at(&self, depth: f64) -> f64 {
        self.sigma.hypotenuse(self.sigma_quadratic * depth * depth)
    }

    /// The inverse depth at a raw `pixel`, if the image has one in range.
    ///
    /// A keypoint is often a corner of an object, where the depth jumps. Half the spread within the 3 x 3 neighbourhood
    /// is added to the noise, so that such a depth has almost no weight.
    pub fn measure(&self, image: &DepthImage, pixel: Vector2) -> Option<InverseDepth> {
        let depth = self.at(image, pixel)?;
        let (x, y) = (pixel.x.round() as usize, pixel.y.round() as usize);
        let (mut low, mut high) = (depth, depth);
        for row in y.saturating_sub(1)..(y + 2).min(image.height()) {
            for &near in &image.row(row)[x.saturating_sub(1)..(x + 2).min(image.width())] {
                if near > 0.0 {
                    (low, high) = (low.min(f64::from(near)), high.max(f64::from(near)));
                }
            }
        }
        let sigma = self.sigma_at(depth).hypotenuse((high - low) / 2.0);
        Some(InverseDepth { value: 1.0 / depth, sigma: sigma / (depth * depth) })
    }

    /// Gradient of the inverse depth at a raw `pixel`, 1/(m px), right and down; constant on a plane. Fitted to pixels of the same surface
    /// up to five times `px` away; zero if these are too few.
    pub fn slope(&self, image: &DepthImage, pixel: Vector2, px: f64) -> Vector2 {
        let Some(middle) = self.at(image, pixel) else { return Vector2::zeros() };
        let (mut normal, mut products) = (Matrix2::zeros(), Vector2::zeros());
        let mut pairs = 0;
        for (x, y) in SLOPE_OFFSETS_PX {
            let offset = (Vector2::new(x, y) * px).map(f64::round);
            let Some((after, before)) = self.at(image, pixel + offset).zip(self.at(image, pixel - offset))
            else {
                continue;
            };
            if (after - middle).abs().max((before - middle).abs()) > MAX_SLOPE_DEPTH_RATIO * middle {
                continue;
            }
            pairs += 1;
            normal += offset * offset.transpose() * 2.0;
            products += offset * (1.0 / after - 1.0 / before);
        }
        let inverse = normal.try_inverse().filter(|_| pairs >= MIN_SLOPE_PAIRS);
        inverse.map_or_else(Vector2::zeros, |inverse| inverse * products)
    }

    /// The depth of the nearest pixel, m, if it is in range.
    pub fn at(&self, image: &DepthImage, pixel: Vector2) -> Option<f64> {
        let (x, y) = (pixel.x.round(), pixel.y.round());
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let depth = f64::from(*image.get(x as usize, y as usize)?);
        (self.nearest..=self.farthest).contains(&depth).then_some(depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_depth_at_a_jump_has_a_large_sigma() {
        let config = DepthConfig::default();
        let image = DepthImage::from_fn(8, 8, |x, _| if x < 4 { 1.0 } else { 3.0 });
        let smooth = config.measure(&image, Vector2::new(1.2, 2.0)).unwrap();
        let edge = config.measure(&image, Vector2::new(3.2, 2.0)).unwrap();
        assert_eq!((smooth.value, edge.value), (1.0, 1.0));
        assert!((smooth.sigma - 0.0103).abs() < 1e-4 && edge.sigma > 1.0);
    }

    #[test]
    fn holes_and_pixels_outside_have_no_depth() {
        let config = DepthConfig::default();
        let mut image = DepthImage::filled(8, 8, 1.0);
        image[(3, 3)] = 0.0;
        image[(4, 3)] = f32::NAN;
        image[(5, 3)] = 9.0;
        for at in [(3.0, 3.0), (4.0, 3.0), (5.0, 3.0), (-1.0, 2.0), (2.0, 8.0), (f64::NAN, 2.0)] {
            assert_eq!(config.measure(&image, Vector2::new(at.0, at.1)), None, "{at:?}");
        }
        assert!(config.measure(&image, Vector2::new(2.0, 3.0)).unwrap().sigma.is_finite());
        assert!(DepthConfig { farthest: 0.1, ..config }.validated().is_err());
    }

    #[test]
    fn the_slope_of_a_plane_is_that_of_its_inverse_depth() {
        let config = DepthConfig::default();
        let plane = |x: usize, y: usize| 0.5 + 0.002 * x as f64 - 0.001 * y as f64;
        let image = DepthImage::from_fn(64, 48, |x, y| (1.0 / plane(x, y)) as f32);
        for px in [1.0, 1.7] {
            let slope = config.slope(&image, Vector2::new(30.2, 20.4), px);
            assert!((slope - Vector2::new(0.002, -0.001)).norm() < 1e-6, "{slope}");
        }
        let mut holed = image;
        holed[(34, 24)] = 0.0;
        let slope = config.slope(&holed, Vector2::new(30.0, 20.0), 1.0);
        assert!((slope - Vector2::new(0.002, -0.001)).norm() < 1e-6, "{slope} with a diagonal pair missing");
        let edge = DepthImage::from_fn(64, 48, |x, _| if x < 32 { 1.0 } else { 3.0 });
        for pixel in [(31.0, 20.0), (f64::NAN, 3.0), (-4.0, 3.0)] {
            assert_eq!(config.slope(&edge, Vector2::new(pixel.0, pixel.1), 1.0), Vector2::zeros());
        }
    }
}

//! An image blurred by a Gaussian, read between pixels.

use trundle_core::GrayImage;
use trundle_core::Vector2;

/// Grey values, blurred.
#[derive(Debug, Clone)]
pub(super) struct SmoothImage {
    pub(super) width: usize,
    pub(super) height: usize,
    values: Vec<f32>,
}

impl SmoothImage {
    /// The image blurred by a Gaussian of standard deviation `sigma`, px.
    pub(super) fn new(image: &GrayImage, sigma: f32) -> Self {
        let (width, height) = (image.width(), image.height());
        let values = image.data().iter().map(|value| f32::from(*value)).collect();
        let sharp = Self { width, height, values };
        let kernel = kernel(sigma);
        sharp.blurred(&kernel, (1, 0)).blurred(&kernel, (0, 1))
    }

    fn blurred(&self, kernel: &[f32], (dx, dy): (i64, i64)) -> Self {
        let radius = kernel.len() as i64 / 2;
        let at = |i: usize| {
            let (x, y) = ((i % self.width) as i64, (i / self.width) as i64);
            let weighted = kernel.iter().enumerate().map(|(k, weight)| {
                let offset = k as i64 - radius;
                weight * self.clamped(x + dx * offset, y + dy * offset)
            });
            weighted.sum()
        };
        let values = (0..self.values.len()).map(at).collect();
        Self { values, ..*self }
    }

    fn clamped(&self, x: i64, y: i64) -> f32 {
        let x = x.clamp(0, self.width as i64 - 1) as usize;
        let y = y.clamp(0, self.height as i64 - 1) as usize;
        self.values[y * self.width + x]
    }

    /// The value of a pixel inside the image.
    pub(super) fn value(&self, x: usize, y: usize) -> f32 {
        self.values[y * self.width + x]
    }

    /// Whether a position is at least `margin` px from the border.
    pub(super) fn contains(&self, at: Vector2, margin: f64) -> bool {
        at.x >= margin
            && at.y >= margin
            && at.x < self.width as f64 - 1.0 - margin
            && at.y < self.height as f64 - 1.0 - margin
    }

    /// The value at a position within the image, bilinear.
    pub(super) fn sample(&self, at: Vector2) -> f64 {
        let (x, y) = (at.x.floor(), at.y.floor());
        let (u, v) = (at.x - x, at.y - y);
        let value = |dx: i64, dy: i64| f64::from(self.clamped(x as i64 + dx, y as i64 + dy));
        (1.0 - v) * ((1.0 - u) * value(0, 0) + u * value(1, 0))
            + v * ((1.0 - u) * value(0, 1) + u * value(1, 1))
    }

    /// The gradient at a position within the image, by central differences, grey values per px.
    pub(super) fn gradient(&self, at: Vector2) -> Vector2 {
        let (right, down) = (Vector2::new(1.0, 0.0), Vector2::new(0.0, 1.0));
        let slope = |step: Vector2| (self.sample(at + step) - self.sample(at - step)) / 2.0;
        Vector2::new(slope(right), slope(down))
    }
}

/// A Gaussian of three standard deviations, sum 1.
fn kernel(sigma: f32) -> Vec<f32> {
    let radius = (3.0 * sigma).ceil() as i32;
    let weight = |i: i32| (-0.5 * (i as f32 / sigma).powi(2)).exp();
    let weights: Vec<f32> = (-radius..=radius).map(weight).collect();
    let sum: f32 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

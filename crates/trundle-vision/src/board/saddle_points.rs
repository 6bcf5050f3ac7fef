//! Candidates for corners of a checkerboard: saddle points of the grey values with four alternating sectors around them.
//!
//! The determinant of the Hessian is negative at a saddle \[Geiger12, sec. III-A\] (the same corners, found there with templates). A ring
//! of samples around a corner changes four times between dark and light, and opposite samples are similar.

use super::smooth_image::SmoothImage;
use trundle_core::Vector2;

/// A candidate for a corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct SaddlePoint {
    /// Position in the image, px.
    pub(super) pixel: Vector2,
    /// Strength: minus the determinant of the Hessian.
    pub(super) strength: f32,
}

/// Radius of the ring: 5 px. Corners of squares below 8 px are not found. Source: ours.
const RING_RADIUS_PX: f64 = 5.0;
/// Samples of the ring. Source: ours.
const RING_SAMPLES: usize = 32;
/// Smallest difference of light and dark on the ring, grey values. Source: ours.
const MIN_CONTRAST: f64 = 15.0;
/// Largest difference of opposite samples, over the contrast. Source: ours.
const MAX_ASYMMETRY: f64 = 0.35;
/// Radius within which a candidate is the strongest: 3 px. Source: ours.
const NEIGHBOURHOOD_PX: usize = 3;
/// Smallest strength, as a ratio to the strongest candidate. Source: ours.
const MIN_STRENGTH_RATIO: f32 = 0.02;

/// The candidates of an image, strongest first.
pub(super) fn saddle_points(image: &SmoothImage) -> Vec<SaddlePoint> {
    let margin = RING_RADIUS_PX as usize + 2;
    if image.width <= 2 * margin || image.height <= 2 * margin {
        return Vec::new();
    }
    let strengths = strengths(image);
    let strength = |x: usize, y: usize| strengths[y * image.width + x];
    let strongest = strengths.iter().copied().fold(0.0, f32::max);
    let mut found = Vec::new();
    for y in margin..image.height - margin {
        for x in margin..image.width - margin {
            let here = strength(x, y);
            if here <= MIN_STRENGTH_RATIO * strongest || !is_maximum(&strength, (x, y)) {
                continue;
            }
            let pixel = Vector2::new(x as f64, y as f64);
            if is_alternating(image, pixel) {
                found.push(SaddlePoint { pixel, strength: here });
            }
        }
    }
    found.sort_by(|a, b| b.strength.total_cmp(&a.strength));
    found
}

/// Minus the determinant of the Hessian at each pixel; 0 on the border.
fn strengths(image: &SmoothImage) -> Vec<f32> {
    let mut strengths = vec![0.0; image.width * image.height];
    for y in 1..image.height - 1 {
        for x in 1..image.width - 1 {
            let v = |dx: usize, dy: usize| image.value(x + dx - 1, y + dy - 1);
            let xx = v(2, 1) - 2.0 * v(1, 1) + v(0, 1);
            let yy = v(1, 2) - 2.0 * v(1, 1) + v(1, 0);
            let xy = (v(2, 2) - v(0, 2) - v(2, 0) + v(0, 0)) / 4.0;
            strengths[y * image.width + x] = xy * xy - xx * yy;
        }
    }
    strengths
}

fn is_maximum(strength: &impl Fn(usize, usize) -> f32, (x, y): (usize, usize)) -> bool {
    let here = strength(x, y);
    let r = NEIGHBOURHOOD_PX;
    (y - r..=y + r).all(|v| {
        (x - r..=x + r).all(|u| {
            let other = strength(u, v);
            // Among equal ones the first is used.
            other < here || (other == here && (v, u) >= (y, x))
        })
    })
}

/// Whether the ring around a pixel has two dark and two light sectors, with similar opposite ones.
fn is_alternating(image: &SmoothImage, pixel: Vector2) -> bool {
    let sample = |i: usize| {
        let angle = i as f64 * std::f64::consts::TAU / RING_SAMPLES as f64;
        image.sample(pixel + RING_RADIUS_PX * Vector2::new(angle.cos(), angle.sin()))
    };
    let ring: Vec<f64> = (0..RING_SAMPLES).map(sample).collect();
    let (low, high) = ring.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
    let contrast = high - low;
    if contrast < MIN_CONTRAST {
        return false;
    }
    let middle = (low + high) / 2.0;
    let changes =
        (0..RING_SAMPLES).filter(|i| (ring[*i] > middle) != (ring[(i + 1) % RING_SAMPLES] > middle));
    let half = RING_SAMPLES / 2;
    let asymmetry: f64 = (0..half).map(|i| (ring[i] - ring[i + half]).abs()).sum::<f64>() / half as f64;
    changes.count() == 4 && asymmetry <= MAX_ASYMMETRY * contrast
}

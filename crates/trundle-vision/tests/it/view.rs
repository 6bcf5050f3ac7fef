//! Rendered views of a textured plane.

use trundle_core::{GrayImage, Vector2};

/// Turns by `degrees` and magnifies around the middle of an image.
pub fn about(
    (width, height): (usize, usize),
    degrees: f64,
    magnification: f64,
) -> impl Fn(Vector2) -> Vector2 {
    let middle = Vector2::new(width as f64 - 1.0, height as f64 - 1.0) / 2.0;
    let turn = nalgebra::Rotation2::new(degrees.to_radians());
    move |p| turn * (p - middle) * magnification + middle
}

/// A view of `image` (at the same size): pixel p shows it at `image_from_view(p)`, by cubic interpolation averaged
/// over the pixel.
pub fn view(image: &GrayImage, image_from_view: impl Fn(Vector2) -> Vector2) -> GrayImage {
    GrayImage::from_fn(image.width(), image.height(), |x, y| {
        let parts = (0..9).map(|k| Vector2::new((k % 3) as f64 - 1.0, (k / 3) as f64 - 1.0) / 3.0);
        let sum: f64 =
            parts.map(|d| cubic(image, image_from_view(Vector2::new(x as f64, y as f64) + d))).sum();
        (sum / 9.0).round().clamp(0.0, 255.0) as u8
    })
}

/// The image between its pixels; outside the border, the border's value.
fn cubic(image: &GrayImage, p: Vector2) -> f64 {
    let weights = |t: f64| {
        [
            ((-0.5 * t + 1.0) * t - 0.5) * t,
            (1.5 * t - 2.5) * t * t + 1.0,
            ((-1.5 * t + 2.0) * t + 0.5) * t,
            (0.5 * t - 0.5) * t * t,
        ]
    };
    let at =
        |v: f64, k: usize, size: usize| (v.floor() as i64 + k as i64 - 1).clamp(0, size as i64 - 1) as usize;
    let (across, down) = (weights(p.x - p.x.floor()), weights(p.y - p.y.floor()));
    let columns: [usize; 4] = std::array::from_fn(|k| at(p.x, k, image.width()));
    (0..4)
        .map(|j| {
            let row = image.row(at(p.y, j, image.height()));
            down[j] * (0..4).map(|i| across[i] * f64::from(row[columns[i]])).sum::<f64>()
        })
        .sum()
}

//! A synthetic texture for the tests.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{GrayImage, Vector2};

/// A fixed hash of a tile, 0 to 1.
fn tile(x: i64, y: i64, layer: u64) -> f64 {
    let mut z = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ (y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f)
        ^ layer.wrapping_mul(0x1656_67b1_9e37_79f9);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z >> 40) as f64 / (1u64 << 24) as f64
}

/// An endless wall of grey tiles of three sizes over each other, 0 to 255.
fn wall(p: Vector2) -> f64 {
    let layer = |size: f64, layer: u64| tile((p.x / size).floor() as i64, (p.y / size).floor() as i64, layer);
    20.0 + 110.0 * layer(41.0, 1) + 70.0 * layer(17.0, 2) + 40.0 * layer(7.0, 3)
}

/// The wall in a camera image: pixel p shows the wall at `wall_from_image(p)`, averaged over the pixel.
pub fn picture((width, height): (usize, usize), wall_from_image: impl Fn(Vector2) -> Vector2) -> GrayImage {
    const PARTS: usize = 3;
    GrayImage::from_fn(width, height, |x, y| {
        let offset = |k: usize| (k as f64 + 0.5) / PARTS as f64 - 0.5;
        let parts = (0..PARTS * PARTS).map(|k| (offset(k % PARTS), offset(k / PARTS)));
        let sum: f64 =
            parts.map(|(dx, dy)| wall(wall_from_image(Vector2::new(x as f64 + dx, y as f64 + dy)))).sum();
        (sum / (PARTS * PARTS) as f64).round() as u8
    })
}

/// The picture with sensor noise: approximately normal, of standard deviation `sigma` grey values.
pub fn noisy(image: &GrayImage, sigma: f64, seed: u64) -> GrayImage {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
    let pixel = |x, y| (f64::from(image[(x, y)]) + sigma * normal()).round().clamp(0.0, 255.0) as u8;
    GrayImage::from_fn(image.width(), image.height(), pixel)
}

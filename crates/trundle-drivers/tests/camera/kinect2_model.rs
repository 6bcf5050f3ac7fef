//! A forward model of the Kinect V2: from distances to noisy measurements to packed bytes. It shares no code with the decoder.

use std::sync::LazyLock;
use trundle_core::{Distortion, PinholeCamera, Vector2};

pub const WIDTH: usize = 512;
pub const HEIGHT: usize = 424;
/// Modulation frequencies \[Hz\].
const FREQUENCIES: [f64; 3] = [80e6, 16e6, 120e6];
/// Amplitude of a white surface at 1 m.
const WHITE_AMPLITUDE: f64 = 2000.0;

/// Random numbers: SplitMix64, Steele et al. 2014.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Normal with deviation 1, by Box and Muller 1958.
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (2.0 * std::f64::consts::PI * self.uniform()).cos()
    }
}

pub fn camera() -> PinholeCamera {
    let lens = Distortion { k1: 0.09, k2: -0.27, p1: 0.0, p2: 0.0, k3: 0.09 };
    PinholeCamera::new((WIDTH, HEIGHT), (365.4, 365.4), (258.2, 206.1), lens).unwrap()
}

/// Offsets of phase that differ from pixel to pixel.
pub fn p0() -> [Vec<u16>; 3] {
    let mut random = Random(7);
    std::array::from_fn(|_| (0..WIDTH * HEIGHT).map(|_| random.next() as u16).collect())
}

/// A surface point: depth along the optical axis \[m\], and its reflectance (1 is white).
pub type Surface = (f64, f64);

/// Nine measurements and the ambient image of each pixel, packed.
pub fn packed_images(
    scene: impl Fn(usize, usize) -> Surface,
    p0: &[Vec<u16>; 3],
    seed: u64,
) -> [Vec<u8>; 10] {
    let (camera, mut random) = (camera(), Random(seed));
    let mut images: [Vec<u8>; 10] = std::array::from_fn(|_| vec![0; WIDTH * HEIGHT * 11 / 8]);
    for (x, y) in (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y))) {
        let (depth, albedo) = scene(x, y);
        let ray = camera.unproject(camera.undistort(Vector2::new(x as f64, y as f64)), 1.0);
        let distance = depth * ray.norm();
        let amplitude = WHITE_AMPLITUDE * albedo / (distance * distance);
        let noise = (25.0 + 0.3 * amplitude).sqrt();
        for (image, packed) in images.iter_mut().enumerate().take(9) {
            let (frequency, shift) = (image / 3, (image % 3) as f64);
            let phase = 4.0 * std::f64::consts::PI * FREQUENCIES[frequency] * distance / 299_792_458.0;
            let offset = p0[frequency][y * WIDTH + x] as f64 / 65_536.0 + shift / 3.0;
            let clean = amplitude * (phase + offset * 2.0 * std::f64::consts::PI).cos();
            put(packed, x, y, code(clean + 40.0 + noise * random.normal()));
        }
        put(&mut images[9], x, y, code(300.0));
    }
    images
}

/// Writes the 11 bits of a pixel, one by one.
fn put(image: &mut [u8], x: usize, y: usize, code: u16) {
    let row = if y < 212 { y + 212 } else { 423 - y };
    let start = (row * WIDTH + (x & 3) * 128 + (x >> 2)) * 11;
    for bit in (0..11).filter(|bit| code >> bit & 1 == 1) {
        image[(start + bit) / 8] |= 1 << ((start + bit) % 8);
    }
}

/// Magnitudes of the codes 0 to 1023: steps of 1 below 256, doubled with every further 128 codes.
static MAGNITUDES: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let mut levels = vec![0.0];
    for code in 1..1024i32 {
        let doublings = ((code - 1) / 128 - 1).max(0);
        levels.push(levels[levels.len() - 1] + 2.0_f64.powi(doublings));
    }
    levels
});

/// The nearest code of a measurement: sign and magnitude; minus zero beyond the last one.
fn code(value: f64) -> u16 {
    let magnitude = value.abs();
    let above = MAGNITUDES.partition_point(|level| *level < magnitude);
    if above == MAGNITUDES.len() {
        return 1024;
    }
    let below = above.saturating_sub(1);
    let is_below_nearer = magnitude - MAGNITUDES[below] < MAGNITUDES[above] - magnitude;
    let nearest = if is_below_nearer { below } else { above } as u16;
    if value < 0.0 && nearest > 0 { nearest + 1024 } else { nearest }
}

//! Files on disk: sequences and recordings, whole and broken.
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "a test")]

mod recording;
mod ros;
mod ros_rgbd;
mod ros_sensors;
mod sequence;
mod tum_writer;

use trundle_core::{ColorImage, DepthImage, RgbdImage, Stamp};

/// A textured frame.
fn frame(stamp: Stamp, width: usize, height: usize) -> RgbdImage {
    let color = ColorImage::from_fn(width, height, |x, y| {
        let wave = ((x as f64 / 11.0).sin() * (y as f64 / 7.0).cos() * 90.0 + 128.0) as u8;
        [wave, wave / 2 + (((x / 16) + (y / 16)) % 2 * 60) as u8, (x + y) as u8]
    });
    let depth = DepthImage::from_fn(width, height, |x, y| {
        if (x / 5 + y / 9) % 13 == 0 { 0.0 } else { ((600 + 3 * y + (x * x) % 40) as u16) as f32 * 0.001 }
    });
    RgbdImage::new(stamp, color, depth).unwrap()
}

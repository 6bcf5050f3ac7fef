//! Median milliseconds a frame for 1000 features of a drawn 640 x 480 image:
//! `cargo run --release -p trundle-vision --example orb_timing`. Set RAYON_NUM_THREADS=1 for one thread.
#![expect(clippy::print_stdout, reason = "it is what the example is for")]

#[path = "../tests/it/texture.rs"]
mod texture;

use std::time::Instant;
use trundle_core::Invalid;
use trundle_vision::{OrbConfig, OrbExtractor, match_mutual};

fn main() -> Result<(), Invalid> {
    let image = texture::noisy(&texture::picture((640, 480), |p| p), 3.0, 1);
    let other = texture::noisy(&image, 3.0, 2);
    let mut orb = OrbExtractor::new(OrbConfig::default())?;
    let (a, b) = (orb.extract(&image), orb.extract(&other));
    let features = a.keypoints.len();
    println!("{features} features: {:.2} ms a frame", median_ms(|| drop(orb.extract(&image))));
    let matching = median_ms(|| drop(match_mutual(&a.descriptors, &b.descriptors, 64, 0.8)));
    println!("{features} x {} descriptors matched: {matching:.2} ms", b.keypoints.len());
    Ok(())
}

fn median_ms(mut work: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..200)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

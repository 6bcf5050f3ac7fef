//! Median times with the built-in vocabulary: reading, conversion of an image of 1000 features, a query among 2000 keyframes. `cargo run
//! --release -p trundle-vision --example vocabulary_timing` Set RAYON_NUM_THREADS=1 for one thread.
#![expect(clippy::print_stdout, reason = "it is what the example is for")]

#[path = "../tests/it/texture.rs"]
mod texture;

use std::time::Instant;
use trundle_core::Invalid;
use trundle_vision::{Descriptor, OrbConfig, OrbExtractor, PlaceIndex, Vocabulary};

/// Keyframes in the index. Source: ours.
const KEYFRAMES: u32 = 2000;

/// Drawn pictures; each keyframe shows a mixture of all. Source: ours.
const PICTURES: usize = 40;

fn main() -> Result<(), Invalid> {
    let start = Instant::now();
    let vocabulary = Vocabulary::builtin();
    println!("builtin, the first time: {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    let bytes = vocabulary.to_bytes();
    println!("{} words, {} bytes", vocabulary.word_count(), bytes.len());
    println!("read from memory: {:.2} ms", median_ms(20, || drop(Vocabulary::from_bytes(&bytes))));
    let mut orb = OrbExtractor::new(OrbConfig::default())?;
    let pool: Vec<Descriptor> = (0..PICTURES)
        .flat_map(|i| {
            let shift = 700.0 * i as f64;
            let image = texture::picture((640, 480), |p| p.map(|v| v + shift));
            orb.extract(&texture::noisy(&image, 3.0, i as u64)).descriptors
        })
        .collect();
    let image: Vec<Descriptor> = pool.iter().copied().step_by(PICTURES).take(1000).collect();
    println!(
        "{} features described: {:.3} ms",
        image.len(),
        median_ms(200, || drop(vocabulary.describe(&image)))
    );
    let mut index = PlaceIndex::default();
    for place in 0..KEYFRAMES {
        index.add(place, &vocabulary.describe(&keyframe(&pool, place as usize)).0);
    }
    let asked = vocabulary.describe(&keyframe(&pool, 777)).0;
    println!(
        "a question about {} words among {KEYFRAMES} keyframes: {:.3} ms",
        asked.entries().len(),
        median_ms(200, || drop(index.query(&asked, |_| true)))
    );
    Ok(())
}

/// 1000 features from a window of the pool that moves with `number`: neighbouring keyframes share features.
fn keyframe(pool: &[Descriptor], number: usize) -> Vec<Descriptor> {
    let first = number * pool.len() / KEYFRAMES as usize;
    pool.iter().cycle().skip(first).step_by(3).take(1000).copied().collect()
}

fn median_ms(times: usize, mut work: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..times)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

//! Determinism of the feature extraction.

use crate::texture::{noisy, picture};
use trundle_core::GrayImage;
use trundle_vision::{Features, OrbConfig, OrbExtractor};

fn with_threads(threads: usize) -> Features {
    let image = noisy(&picture((640, 480), |p| p), 3.0, 5);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| OrbExtractor::new(OrbConfig::default()).unwrap().extract(&image))
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    assert_eq!(with_threads(1), with_threads(2));
}

#[test]
fn an_extraction_does_not_depend_on_the_one_before() {
    let (one, other) = (picture((320, 240), |p| p), picture((200, 180), |p| p * 1.3));
    let fresh = |image: &GrayImage| OrbExtractor::new(OrbConfig::default()).unwrap().extract(image);
    let mut used = OrbExtractor::new(OrbConfig::default()).unwrap();
    for image in [&one, &other, &one, &one] {
        assert_eq!(used.extract(image), fresh(image));
    }
    // Widths whose levels have rows with remainders of every length in the last word.
    let wall = noisy(&picture((400, 150), |p| p * 0.7), 9.0, 3);
    for width in [400, 256, 397, 301, 400, 233, 398] {
        let cut = GrayImage::from_fn(width, 150, |x, y| wall[(x, y)]);
        assert_eq!(used.extract(&cut), fresh(&cut), "{width} px wide");
    }
}

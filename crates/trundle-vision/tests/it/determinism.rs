use crate::texture::{noisy, picture};
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
fn what_was_extracted_before_does_not_matter() {
    let (one, other) = (picture((320, 240), |p| p), picture((200, 180), |p| p * 1.3));
    let fresh = |image| OrbExtractor::new(OrbConfig::default()).unwrap().extract(image);
    let mut used = OrbExtractor::new(OrbConfig::default()).unwrap();
    for image in [&one, &other, &one, &one] {
        assert_eq!(used.extract(image), fresh(image));
    }
}

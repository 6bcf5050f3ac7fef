//! Spread of the features over the image.

use crate::texture::picture;
use trundle_core::GrayImage;
use trundle_vision::{Features, OrbConfig, OrbExtractor};

fn extracted(image: &GrayImage, features: usize) -> Features {
    let mut config = OrbConfig::default();
    config.features = features;
    OrbExtractor::new(config).unwrap().extract(image)
}

#[test]
fn a_faint_half_has_features_too() {
    let mut image = picture((640, 480), |p| p);
    for y in 0..480 {
        image.row_mut(y)[320..].iter_mut().for_each(|v| *v = 110 + *v / 6);
    }
    let features = extracted(&image, 1000);
    let faint = features.keypoints.iter().filter(|k| k.x > 320.0).count();
    assert!(faint > 300, "{faint} of {} in the faint half", features.keypoints.len());
}

#[test]
fn every_part_of_an_image_has_its_share() {
    let features = extracted(&picture((640, 480), |p| p), 1000);
    assert_eq!(features.keypoints.len(), 1000);
    let mut blocks = [0; 12];
    for k in &features.keypoints {
        blocks[k.y as usize / 160 * 4 + k.x as usize / 160] += 1;
    }
    assert!(blocks.iter().all(|n| (30..170).contains(n)), "{blocks:?}");
}

#[test]
fn the_requested_number_of_corners_lies_within_the_image() {
    let image = picture((320, 240), |p| p);
    for asked in [1, 10, 333] {
        let features = extracted(&image, asked);
        assert_eq!((features.keypoints.len(), features.descriptors.len()), (asked, asked));
        assert!(features.keypoints.is_sorted_by_key(|k| k.octave));
        assert!(features.keypoints.iter().all(|k| k.x >= 15.5 && k.x < 304.5 && k.y >= 15.5 && k.y < 224.5));
    }
}

#[test]
fn tiny_images_have_none() {
    for (width, height) in [(0, 0), (1, 1), (32, 200), (200, 32), (3, 3)] {
        let image = GrayImage::from_fn(width, height, |x, y| (x * 71 + y * 113) as u8);
        assert_eq!(extracted(&image, 100), Features::default(), "{width} x {height}");
    }
    let just = GrayImage::from_fn(33, 33, |x, y| if (x, y) == (16, 16) { 255 } else { 0 });
    assert_eq!(extracted(&just, 100).keypoints.len(), 1);
}

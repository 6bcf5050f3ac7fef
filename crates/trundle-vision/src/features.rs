//! Keypoints and descriptors of an image.

use crate::ImagePatch;

/// A corner found in an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keypoint {
    /// Column in the full-size raw image, px, 0 being the centre of the first one; good to a fraction of a pixel.
    pub x: f32,
    /// Row in the full-size raw image, px.
    pub y: f32,
    /// Level of the image pyramid; 0 is full size.
    pub octave: u8,
    /// Orientation by the intensity centroid, rad, image axes (x right, y down).
    pub angle: f32,
    /// Corner strength.
    pub response: f32,
}

/// A 256-bit oriented BRIEF descriptor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Descriptor(pub [u64; 4]);

impl Descriptor {
    /// The number of bits in which two descriptors differ, 0 to 256.
    #[inline]
    pub fn distance(&self, other: &Self) -> u32 {
        self.0.iter().zip(&other.0).map(|(a, b)| (a ^ b).count_ones()).sum()
    }
}

/// ORB features of one image: keypoint i has descriptor i.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Features {
    /// The corners, in a fixed order.
    pub keypoints: Vec<Keypoint>,
    /// Descriptors of the keypoints.
    pub descriptors: Vec<Descriptor>,
    /// Image patches around the keypoints; empty if not requested.
    pub patches: Vec<ImagePatch>,
}

impl Features {
    /// Removes all features except those whose indices are wanted; preserves the order.
    pub fn retain(&mut self, wants: impl Fn(usize) -> bool) {
        let mut kept = 0;
        for i in 0..self.keypoints.len().min(self.descriptors.len()) {
            if wants(i) {
                self.keypoints.swap(kept, i);
                self.descriptors.swap(kept, i);
                if i < self.patches.len() {
                    self.patches.swap(kept, i);
                }
                kept += 1;
            }
        }
        self.keypoints.truncate(kept);
        self.descriptors.truncate(kept);
        self.patches.truncate(kept);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_features_stay_together_and_in_order() {
        let keypoint = |i: u8| Keypoint { x: f32::from(i), y: 0.0, octave: 0, angle: 0.0, response: 1.0 };
        let mut features = Features {
            keypoints: (0..9).map(keypoint).collect(),
            descriptors: (0..9).map(|i| Descriptor([i; 4])).collect(),
            patches: (0..9).filter_map(|i| ImagePatch::new([i; ImagePatch::BYTES], [0.0; 2])).collect(),
        };
        features.retain(|i| i % 3 == 1);
        let places: Vec<f32> = features.keypoints.iter().map(|k| k.x).collect();
        let words: Vec<u64> = features.descriptors.iter().map(|d| d.0[0]).collect();
        assert_eq!((places, words), (vec![1.0, 4.0, 7.0], vec![1, 4, 7]));
        assert_eq!(features.patches.iter().map(|p| p.pixels()[0]).collect::<Vec<_>>(), vec![1, 4, 7]);
    }
}

/// A corner found in an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keypoint {
    /// Column in the full-size raw image, px, 0 being the centre of the first one; good to a fraction of a pixel.
    pub x: f32,
    /// Row in the full-size raw image, px.
    pub y: f32,
    /// Level of the image pyramid it was found on: 0 is full size.
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

/// What ORB finds in one image: keypoint i has descriptor i.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Features {
    /// The corners, in a fixed order.
    pub keypoints: Vec<Keypoint>,
    /// Their descriptors.
    pub descriptors: Vec<Descriptor>,
}

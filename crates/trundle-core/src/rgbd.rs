//! An RGB-D image: a colour image and the depth image registered to it.

use crate::{ColorImage, DepthImage, Invalid, Stamp};

/// Largest factor between the sides of a colour image and its depth image. Source: ours; 1280 x 720 colour with depth of 320 x 180.
const MAX_DEPTH_FACTOR: usize = 4;

/// One RGB-D frame: a colour image and the depth image registered to it, pixel for pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct RgbdImage {
    stamp: Stamp,
    color: ColorImage,
    depth: DepthImage,
}

impl RgbdImage {
    /// A frame taken at `stamp`.
    ///
    /// # Errors
    /// When the two images differ in size.
    pub fn new(stamp: Stamp, color: ColorImage, depth: DepthImage) -> Result<Self, Invalid> {
        if !color.same_size(&depth) {
            let value = format!("{} x {}", depth.width(), depth.height());
            let expected = format!("{} x {} as the colour image", color.width(), color.height());
            return Err(Invalid::new("depth image size", value, "px", expected));
        }
        Ok(Self { stamp, color, depth })
    }

    /// A frame whose registered depth image may have a half, a third or a quarter of the columns and of the rows of the colour image: each depth
    /// is then that of a square of colour pixels.
    ///
    /// # Errors
    /// When the sides of the images have another ratio.
    pub fn of_registered(stamp: Stamp, color: ColorImage, depth: DepthImage) -> Result<Self, Invalid> {
        let (width, height) = (color.width(), color.height());
        let factor = (2..=MAX_DEPTH_FACTOR)
            .find(|factor| (depth.width() * factor, depth.height() * factor) == (width, height));
        let depth = match factor {
            Some(factor) => DepthImage::from_fn(width, height, |x, y| {
                depth.get(x / factor, y / factor).copied().unwrap_or_default()
            }),
            None => depth,
        };
        Self::new(stamp, color, depth)
    }

    /// Stamp of the image.
    pub fn stamp(&self) -> Stamp {
        self.stamp
    }

    /// The colour and the depth image, whose memory may serve the next frame.
    pub fn into_images(self) -> (ColorImage, DepthImage) {
        (self.color, self.depth)
    }

    /// The colour image.
    pub fn color(&self) -> &ColorImage {
        &self.color
    }

    /// The depth image, metres along the optical axis, 0 for unknown.
    pub fn depth(&self) -> &DepthImage {
        &self.depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_of_a_part_of_the_size_is_that_of_squares_of_pixels() {
        let color = |width, height| ColorImage::filled(width, height, [9; 3]);
        let depth = DepthImage::from_fn(2, 2, |x, y| 1.0 + x as f32 + 10.0 * y as f32);
        let image = RgbdImage::of_registered(Stamp::default(), color(4, 4), depth.clone()).unwrap();
        let at = |x, y| *image.depth().get(x, y).unwrap();
        assert_eq!([at(0, 0), at(1, 1), at(2, 1), at(1, 2), at(3, 3)], [1.0, 1.0, 2.0, 11.0, 12.0]);
        for (width, height) in [(4, 6), (3, 2), (10, 10)] {
            let refused = RgbdImage::of_registered(Stamp::default(), color(width, height), depth.clone());
            assert!(refused.unwrap_err().to_string().contains("depth image size is 2 x 2 px"));
        }
        let same = RgbdImage::of_registered(Stamp::default(), color(2, 2), depth.clone()).unwrap();
        assert_eq!(*same.depth(), depth);
    }
}

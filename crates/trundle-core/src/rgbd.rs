//! An RGB-D image: a colour image and the depth image registered to it.

use crate::{ColorImage, DepthImage, Invalid, Stamp};

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

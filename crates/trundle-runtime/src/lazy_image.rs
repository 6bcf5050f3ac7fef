//! An image that is decoded at its first use.

use std::fmt;
use trundle_core::{RgbdImage, Stamp};

/// An image that is decoded at its first use: a dropped image is never decoded.
pub struct LazyImage {
    stamp: Stamp,
    load: Box<dyn FnOnce() -> Result<RgbdImage, String> + Send>,
}

impl LazyImage {
    /// An image taken at `stamp`, which `load` decodes at its first use. An error is a sentence for the user.
    pub fn new(stamp: Stamp, load: impl FnOnce() -> Result<RgbdImage, String> + Send + 'static) -> Self {
        Self { stamp, load: Box::new(load) }
    }

    /// Stamp of the image.
    pub fn stamp(&self) -> Stamp {
        self.stamp
    }

    pub(crate) fn load(self) -> Result<RgbdImage, String> {
        (self.load)()
    }
}

impl From<RgbdImage> for LazyImage {
    fn from(image: RgbdImage) -> Self {
        Self::new(image.stamp(), || Ok(image))
    }
}

impl fmt::Debug for LazyImage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LazyImage").field("stamp", &self.stamp).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU32, Ordering};
    use trundle_core::{DepthImage, Image};

    #[test]
    fn an_image_that_nobody_asks_for_is_not_decoded() {
        let decoded = Arc::new(AtomicU32::new(0));
        let counter = Arc::clone(&decoded);
        let image = LazyImage::new(Stamp::from_nanos(3), move || {
            counter.fetch_add(1, Ordering::Relaxed);
            Err("no JPEG".to_owned())
        });
        assert_eq!((image.stamp(), decoded.load(Ordering::Relaxed)), (Stamp::from_nanos(3), 0));
        assert_eq!(image.load().unwrap_err(), "no JPEG");
        assert_eq!(decoded.load(Ordering::Relaxed), 1);
    }

    #[test]
    fn a_decoded_image_comes_back_as_it_is() {
        let image =
            RgbdImage::new(Stamp::from_nanos(3), Image::filled(4, 2, [9; 3]), DepthImage::filled(4, 2, 1.0));
        let image = image.unwrap();
        assert_eq!(LazyImage::from(image.clone()).load().unwrap().depth().data(), image.depth().data());
    }
}

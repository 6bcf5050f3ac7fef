//! An image that is decoded when it is needed.

use std::fmt;
use trundle_core::{RgbdImage, Stamp};

/// An image that is decoded where it is looked at, so that one that nobody looks at costs nothing.
pub struct LazyImage {
    stamp: Stamp,
    load: Box<dyn FnOnce() -> Result<RgbdImage, String> + Send>,
}

impl LazyImage {
    /// An image taken at `stamp` that `load` gives when it is asked for; its error is a sentence for people.
    pub fn new(stamp: Stamp, load: impl FnOnce() -> Result<RgbdImage, String> + Send + 'static) -> Self {
        Self { stamp, load: Box::new(load) }
    }

    /// When it was taken.
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

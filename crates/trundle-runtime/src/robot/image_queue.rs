//! The queue of a perception job.

use super::event_log::{self, DroppedImage};
use crate::lazy_image::LazyImage;
use trundle_core::Stamp;

/// Holds one image; a newer one replaces it.
#[derive(Debug, Default)]
pub(super) struct ImageQueue {
    waiting: Option<LazyImage>,
    /// Stamps of the dropped images.
    dropped: Vec<Stamp>,
}

impl ImageQueue {
    /// Queues an image; a waiting image is dropped.
    pub(super) fn push(&mut self, image: LazyImage) {
        if let Some(old) = self.waiting.replace(image) {
            self.drop_image(old.stamp(), DroppedImage::Replaced);
        }
    }

    /// Removes and returns the waiting image.
    pub(super) fn take(&mut self) -> Option<LazyImage> {
        self.waiting.take()
    }

    /// Records the stamp of a dropped image.
    pub(super) fn drop_image(&mut self, stamp: Stamp, why: DroppedImage) {
        event_log::dropped_image(stamp, why);
        self.dropped.push(stamp);
    }

    /// Stamps of the dropped images, oldest first.
    pub(super) fn dropped(&self) -> &[Stamp] {
        &self.dropped
    }
}

#[cfg(test)]
mod tests;

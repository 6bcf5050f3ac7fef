//! Images that wait for a perception job.

use super::event_log::{self, DroppedImage};
use crate::lazy_image::LazyImage;
use trundle_core::Stamp;

/// Holds one image; a newer one replaces it.
#[derive(Debug, Default)]
pub(super) struct ImageQueue {
    waiting: Option<LazyImage>,
    /// Stamps of the images that were dropped.
    dropped: Vec<Stamp>,
}

impl ImageQueue {
    /// Queues an image. The newest replaces the one that waits, which is dropped.
    pub(super) fn push(&mut self, image: LazyImage) {
        if let Some(old) = self.waiting.replace(image) {
            self.drop_image(old.stamp(), DroppedImage::Replaced);
        }
    }

    /// The image that waits leaves.
    pub(super) fn take(&mut self) -> Option<LazyImage> {
        self.waiting.take()
    }

    /// Keeps the stamp of an image that is dropped.
    pub(super) fn drop_image(&mut self, stamp: Stamp, why: DroppedImage) {
        event_log::dropped_image(stamp, why);
        self.dropped.push(stamp);
    }

    /// Stamps of the images that were dropped, oldest first.
    pub(super) fn dropped(&self) -> &[Stamp] {
        &self.dropped
    }
}

//! Images of the camera, for views.

use super::DepthView;
use super::run_view::ImageView;
use std::sync::Arc;
use std::time::{Duration, Instant};
use trundle_core::{DepthImage, RgbdImage, Stamp};
use trundle_io::{JPEG_QUALITY, encode_color};

/// Time between two copies of the camera's image \[s\]. A copy of 100 kB takes 10 us. Source: ours.
const IMAGE_PERIOD_S: f64 = 0.1;
/// Wall-clock time between two images that are encoded only for views. A simulator runs faster than real time, and encoding takes some 3
/// ms. Source: ours; a page receives one image per 180 ms.
const ENCODING_PERIOD: Duration = Duration::from_millis(150);

/// Keeps the newest image of the camera.
#[derive(Debug, Default)]
pub(crate) struct ImageFeed {
    image: Option<Arc<ImageView>>,
    depth: Option<Arc<DepthView>>,
    /// Time of the last image encoded only for views.
    encoded: Option<Instant>,
}

impl ImageFeed {
    /// Copies an image with its recorded depth if the last copy is old.
    pub(crate) fn note_encoded(&mut self, stamp: Stamp, jpeg: &[u8], depth: &[u8]) {
        if self.image.as_ref().is_none_or(|image| is_apart(image.stamp, stamp, IMAGE_PERIOD_S)) {
            self.image = Some(Arc::new(ImageView { stamp, jpeg: jpeg.to_vec() }));
            self.depth = Some(Arc::new(DepthView::of_encoded(stamp, depth)));
        }
    }

    /// Copies an image if the last copy is old.
    pub(crate) fn note_jpeg(&mut self, stamp: Stamp, jpeg: &[u8]) {
        if self.image.as_ref().is_none_or(|image| is_apart(image.stamp, stamp, IMAGE_PERIOD_S)) {
            self.image = Some(Arc::new(ImageView { stamp, jpeg: jpeg.to_vec() }));
        }
    }

    /// Copies a depth image if the last copy is old.
    pub(crate) fn note_depth(&mut self, stamp: Stamp, depth: &DepthImage) {
        let is_due = |last: &Arc<DepthView>| is_apart(last.stamp, stamp, IMAGE_PERIOD_S);
        if self.depth.as_ref().is_none_or(is_due) {
            self.depth = Some(Arc::new(DepthView::of(stamp, depth)));
        }
    }

    /// Encodes an image of a simulator at a limited rate. An image that cannot be encoded is not shown. Returns whether it is shown.
    pub(crate) fn note_rgbd(&mut self, image: &RgbdImage) -> bool {
        if self.encoded.is_some_and(|encoded| encoded.elapsed() < ENCODING_PERIOD) {
            return false;
        }
        let Ok(jpeg) = encode_color(image.color(), JPEG_QUALITY) else { return false };
        let stamp = image.stamp();
        self.image = Some(Arc::new(ImageView { stamp, jpeg }));
        self.depth = Some(Arc::new(DepthView::of(stamp, image.depth())));
        self.encoded = Some(Instant::now());
        true
    }

    /// The newest colour image.
    pub(crate) fn image(&self) -> Option<Arc<ImageView>> {
        self.image.clone()
    }

    /// The newest depth image.
    pub(crate) fn depth(&self) -> Option<Arc<DepthView>> {
        self.depth.clone()
    }
}

/// Whether a time is a period after the last one, or before it.
fn is_apart(last: Stamp, stamp: Stamp, period: f64) -> bool {
    let since = stamp - last;
    since >= period || since < 0.0
}

//! Colour and depth that arrive one by one, put together by their stamps.

use crate::camera::{CameraFrame, RawImage};

/// Largest time between the images of a pair, in periods of the slower stream. Images further apart are not paired. Source: ours, half a
/// period with 2 % for the jitter of the clocks.
const MAX_PAIR_GAP_PERIODS: f64 = 0.51;

/// Largest time between the images of a pair \[s\]; `rate_hz` is the rate of the slower stream \[Hz\], above 0.
pub(in crate::camera) fn max_gap_s(rate_hz: f64) -> f64 {
    MAX_PAIR_GAP_PERIODS / rate_hz
}

/// The newest image of each kind.
#[derive(Debug)]
pub(in crate::camera) struct ImagePair {
    max_gap_s: f64,
    /// The newest colour image.
    pub(in crate::camera) color: Option<RawImage>,
    /// The newest depth image.
    pub(in crate::camera) depth: Option<RawImage>,
}

impl ImagePair {
    /// No images; `rate_hz` is the rate of the slower stream \[Hz\], above 0.
    pub(in crate::camera) fn new(rate_hz: f64) -> Self {
        Self { max_gap_s: max_gap_s(rate_hz), color: None, depth: None }
    }

    /// A pair of images of the same time; the older one of two that do not fit is dropped.
    pub(in crate::camera) fn take(&mut self) -> Option<CameraFrame> {
        let gap_s = self.color.as_ref()?.device_stamp - self.depth.as_ref()?.device_stamp;
        if gap_s.abs() <= self.max_gap_s {
            return Some(CameraFrame { color: self.color.take()?, depth: self.depth.take()? });
        }
        if gap_s < 0.0 {
            self.color = None
        } else {
            self.depth = None
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PixelFormat;
    use trundle_core::Stamp;

    fn image(ms: i64) -> Option<RawImage> {
        Some(RawImage::packed(PixelFormat::Gray8, (1, 1), vec![0], Stamp::from_nanos(ms * 1_000_000)))
    }

    #[test]
    fn images_of_the_same_time_become_a_pair() {
        let mut pair = ImagePair { color: image(10), depth: image(26), ..ImagePair::new(30.0) };
        assert!(pair.take().is_some() && pair.color.is_none() && pair.depth.is_none());
    }

    #[test]
    fn the_older_image_waits_no_longer() {
        let mut pair = ImagePair { color: image(10), depth: image(28), ..ImagePair::new(30.0) };
        assert!(pair.take().is_none() && pair.color.is_none() && pair.depth.is_some());
    }
}

//! Colour and depth that arrive one by one, put together by their stamps.

use crate::camera::{CameraFrame, RawImage};
use std::collections::VecDeque;

/// Largest time between the images of a pair, in periods of the slower stream. Images further apart are not paired. Source: ours, half a
/// period with 2 % for the jitter of the clocks.
const MAX_PAIR_GAP_PERIODS: f64 = 0.51;

/// Images of each kind that wait for the other kind.
#[derive(Debug)]
pub(in crate::camera) struct ImagePair {
    max_gap_s: f64,
    max_waiting: usize,
    colors: VecDeque<RawImage>,
    depths: VecDeque<RawImage>,
}

impl ImagePair {
    /// No images; the newest image of each kind waits. `rate_hz` is the rate of the slower stream \[Hz\], above 0.
    pub(in crate::camera) fn new(rate_hz: f64) -> Self {
        Self::with_waiting(rate_hz, 1)
    }

    /// As [`ImagePair::new`], with up to `max_waiting` images of each kind, for streams of which one leads.
    pub(in crate::camera) fn with_waiting(rate_hz: f64, max_waiting: usize) -> Self {
        let max_gap_s = MAX_PAIR_GAP_PERIODS / rate_hz;
        Self { max_gap_s, max_waiting, colors: VecDeque::new(), depths: VecDeque::new() }
    }

    /// Adds a colour image; the oldest one is dropped if too many wait.
    pub(in crate::camera) fn add_color(&mut self, image: RawImage) {
        add(&mut self.colors, image, self.max_waiting);
    }

    /// Adds a depth image; the oldest one is dropped if too many wait.
    pub(in crate::camera) fn add_depth(&mut self, image: RawImage) {
        add(&mut self.depths, image, self.max_waiting);
    }

    /// Drops the waiting colour images.
    pub(in crate::camera) fn drop_colors(&mut self) {
        self.colors.clear();
    }

    /// Numbers of waiting colour and depth images.
    pub(in crate::camera) fn waiting(&self) -> [usize; 2] {
        [self.colors.len(), self.depths.len()]
    }

    /// A pair of images of the same time; the older one of two that do not fit is dropped.
    pub(in crate::camera) fn take(&mut self) -> Option<CameraFrame> {
        let (colors, depths) = (&mut self.colors, &mut self.depths);
        loop {
            let gap_s = colors.front()?.device_stamp - depths.front()?.device_stamp;
            if gap_s.abs() <= self.max_gap_s {
                return Some(CameraFrame { color: colors.pop_front()?, depth: depths.pop_front()? });
            }
            if gap_s < 0.0 {
                colors.pop_front()
            } else {
                depths.pop_front()
            };
        }
    }
}

fn add(waiting: &mut VecDeque<RawImage>, image: RawImage, max_waiting: usize) {
    waiting.push_back(image);
    if waiting.len() > max_waiting {
        waiting.pop_front();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PixelFormat;
    use trundle_core::Stamp;

    /// A pair of a colour and a depth image with these stamps \[ms\].
    fn pair(color_ms: i64, depth_ms: i64) -> ImagePair {
        let image = |ms: i64| {
            RawImage::packed(PixelFormat::Gray8, (1, 1), vec![0], Stamp::from_nanos(ms * 1_000_000))
        };
        let mut pair = ImagePair::new(30.0);
        pair.add_color(image(color_ms));
        pair.add_depth(image(depth_ms));
        pair
    }

    #[test]
    fn images_of_the_same_time_become_a_pair() {
        let mut pair = pair(10, 26);
        assert!(pair.take().is_some() && pair.waiting() == [0, 0]);
    }

    #[test]
    fn the_older_image_waits_no_longer() {
        let mut pair = pair(10, 28);
        assert!(pair.take().is_none() && pair.waiting() == [0, 1]);
    }
}

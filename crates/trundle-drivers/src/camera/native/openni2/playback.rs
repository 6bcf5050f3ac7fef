//! A recording of OpenNI2: its images in the order of the file, put together, and its end.
//!
//! The library plays one image for each that is read. Images of one kind may lead by some frames.

use super::session::Kind;
use crate::camera::native::image_pair::ImagePair;
use crate::camera::{CameraFrame, RawImage};
use std::ffi::c_int;
use std::time::{Duration, Instant};

/// Largest number of images of a kind that wait for the other kind: 30, one second. Source: ours.
const MAX_WAITING_IMAGES: usize = 30;
/// Time without an image after which a damaged recording has ended: 2 s. Source: ours; a whole one ends with its last image.
const END_SILENCE: Duration = Duration::from_secs(2);

/// Adds an image; returns the pair that it completes.
pub(super) fn add(pair: &mut ImagePair, kind: Kind, image: RawImage) -> Option<CameraFrame> {
    match kind {
        Kind::Color => pair.add_color(image),
        Kind::Depth => pair.add_depth(image),
    }
    pair.take()
}

/// The state of a recording.
#[derive(Debug)]
pub(super) struct Playback {
    pair: ImagePair,
    /// Number of colour and depth images in the file.
    totals: [c_int; 2],
    /// Numbers of the newest colour and depth image, which count from 1.
    newest: [c_int; 2],
    silent_since: Option<Instant>,
    has_ended: bool,
}

impl Playback {
    /// The start of a recording with these numbers of colour and depth images; `rate_hz` is the rate of the slower stream \[Hz\], above 0.
    pub(super) fn new(totals: [c_int; 2], rate_hz: f64) -> Self {
        let has_ended = totals.contains(&0);
        Self {
            pair: ImagePair::with_waiting(rate_hz, MAX_WAITING_IMAGES),
            totals,
            newest: [0; 2],
            silent_since: None,
            has_ended,
        }
    }

    /// Adds the image with this number of its kind; returns the pair that it completes. An image without a partner is dropped.
    pub(super) fn add(&mut self, kind: Kind, image: RawImage, number: c_int) -> Option<CameraFrame> {
        self.silent_since = None;
        self.newest[kind as usize] = number;
        self.has_ended = self.newest.iter().zip(&self.totals).all(|(newest, total)| newest >= total);
        add(&mut self.pair, kind, image)
    }

    /// Records at `now` that no image came.
    pub(super) fn on_silence(&mut self, now: Instant) {
        let since = *self.silent_since.get_or_insert(now);
        self.has_ended |= now - since >= END_SILENCE;
    }

    /// Whether no image will follow.
    pub(super) fn has_ended(&self) -> bool {
        self.has_ended
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PixelFormat;
    use trundle_core::Stamp;

    fn image(number: c_int) -> RawImage {
        let stamp = Stamp::from_nanos(i64::from(number) * 33_000_000);
        RawImage::packed(PixelFormat::Gray8, (1, 1), vec![0], stamp)
    }

    /// Numbers of the pairs out of images in this order, each with its place in the order.
    fn pairs(playback: &mut Playback, order: &[(Kind, c_int)]) -> Vec<(usize, i64)> {
        let mut pairs = Vec::new();
        for (place, (kind, number)) in order.iter().enumerate() {
            if let Some(frame) = playback.add(*kind, image(*number), *number) {
                assert_eq!(frame.color.device_stamp, frame.depth.device_stamp);
                pairs.push((place, frame.color.device_stamp.nanos / 33_000_000));
            }
        }
        pairs
    }

    #[test]
    fn depth_that_leads_by_two_frames_loses_no_pair() {
        use Kind::{Color, Depth};
        let mut playback = Playback::new([3, 3], 30.0);
        let order = [(Depth, 1), (Depth, 2), (Color, 1), (Depth, 3), (Color, 2)];
        assert_eq!(pairs(&mut playback, &order), [(2, 1), (4, 2)]);
        assert!(!playback.has_ended());
        assert_eq!(pairs(&mut playback, &[(Color, 3)]), [(0, 3)]);
        assert!(playback.has_ended());
    }

    #[test]
    fn an_image_without_a_partner_is_dropped_and_the_store_is_bounded() {
        use Kind::{Color, Depth};
        let mut playback = Playback::new([5, 5], 30.0);
        assert_eq!(
            pairs(&mut playback, &[(Color, 1), (Color, 2), (Depth, 2), (Depth, 3), (Color, 3)]),
            [(2, 2), (4, 3)]
        );
        let alone: Vec<(Kind, c_int)> = (4..100).map(|number| (Depth, number)).collect();
        assert!(pairs(&mut playback, &alone).is_empty());
        assert_eq!(playback.pair.waiting()[1], MAX_WAITING_IMAGES);
    }

    #[test]
    fn a_cut_or_empty_recording_ends() {
        let mut playback = Playback::new([5, 5], 30.0);
        let now = Instant::now();
        playback.on_silence(now);
        playback.add(Kind::Color, image(1), 1);
        playback.on_silence(now + Duration::from_secs(3));
        assert!(!playback.has_ended(), "an image came in between");
        playback.on_silence(now + Duration::from_millis(5100));
        assert!(playback.has_ended());
        assert!(Playback::new([0, 5], 30.0).has_ended());
    }
}

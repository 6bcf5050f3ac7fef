//! Colour and depth of librealsense2, put together.

use super::constants::{DOMAIN_HARDWARE_CLOCK, STREAM_COLOR, STREAM_DEPTH};
use super::frames::Content;
use crate::camera::native::image_pair::ImagePair;
use crate::camera::{CameraFrame, RawImage};
use std::ffi::c_int;
use trundle_core::Invalid;

/// Pairs images of the same time. A set of the library may repeat an image of the previous set, or contain images of different times.
#[derive(Debug)]
pub(super) struct Pairing {
    pair: ImagePair,
    color: Source,
    depth: Source,
}

/// The last image of a stream.
#[derive(Debug, Default)]
struct Source {
    number: Option<u64>,
    domain: c_int,
}

impl Source {
    /// The image, unless it is a repetition.
    fn take_new(&mut self, image: RawImage, number: u64, domain: c_int) -> Option<RawImage> {
        let is_new = self.number != Some(number);
        *self = Self { number: Some(number), domain };
        is_new.then_some(image)
    }
}

impl Pairing {
    /// No images; `rate_hz` is the rate of the slower stream \[Hz\], above 0.
    pub(super) fn new(rate_hz: f64) -> Self {
        Self { pair: ImagePair::new(rate_hz), color: Source::default(), depth: Source::default() }
    }

    /// The next frame, after the images of a set; `None` if an image is missing.
    ///
    /// # Errors
    /// When only one of the images has a stamp of the camera's own clock.
    pub(super) fn pair(&mut self, contents: Vec<Content>) -> Option<Result<CameraFrame, Invalid>> {
        for content in contents {
            match content {
                Content::Image { stream: STREAM_COLOR, image, number, domain } => {
                    let new = self.color.take_new(image, number, domain);
                    new.into_iter().for_each(|image| self.pair.add_color(image));
                }
                Content::Image { stream: STREAM_DEPTH, image, number, domain } => {
                    let new = self.depth.take_new(image, number, domain);
                    new.into_iter().for_each(|image| self.pair.add_depth(image));
                }
                _ => {}
            }
        }
        if !self.pair.waiting().contains(&0) && self.has_two_clocks() {
            self.pair.drop_colors();
            return Some(Err(self.two_clocks()));
        }
        self.pair.take().map(Ok)
    }

    fn has_two_clocks(&self) -> bool {
        (self.color.domain == DOMAIN_HARDWARE_CLOCK) != (self.depth.domain == DOMAIN_HARDWARE_CLOCK)
    }

    fn two_clocks(&self) -> Invalid {
        let found = format!("{} for colour, {} for depth", self.color.domain, self.depth.domain);
        Invalid::new("timestamp domain of librealsense", found, "", "one clock for both")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PixelFormat;
    use trundle_core::Stamp;

    /// An image with a number, 33 ms after the previous one.
    fn image(stream: c_int, number: u64, domain: c_int) -> Content {
        let stamp = Stamp::from_nanos(number as i64 * 33_000_000);
        let image = RawImage::packed(PixelFormat::Gray8, (1, 1), vec![0], stamp);
        Content::Image { stream, image, number, domain }
    }

    fn numbers(pairing: &mut Pairing, color: u64, depth: u64) -> Option<(i64, i64)> {
        let set = vec![image(STREAM_DEPTH, depth, 0), image(STREAM_COLOR, color, 0)];
        let frame = pairing.pair(set)?.unwrap();
        Some((frame.color.device_stamp.nanos / 33_000_000, frame.depth.device_stamp.nanos / 33_000_000))
    }

    #[test]
    fn a_repeated_image_is_left_out() {
        let mut pairing = Pairing::new(30.0);
        assert_eq!(numbers(&mut pairing, 1, 1), Some((1, 1)));
        assert_eq!(numbers(&mut pairing, 1, 2), None);
        assert_eq!(numbers(&mut pairing, 2, 2), Some((2, 2)));
    }

    #[test]
    fn images_of_different_times_wait_for_their_partners() {
        let mut pairing = Pairing::new(30.0);
        assert_eq!(numbers(&mut pairing, 1, 2), None);
        assert_eq!(numbers(&mut pairing, 2, 2), Some((2, 2)));
        assert_eq!(numbers(&mut pairing, 2, 3), None);
    }

    #[test]
    fn two_clocks_in_one_set_are_refused() {
        let mut pairing = Pairing::new(30.0);
        let mixed = vec![image(STREAM_DEPTH, 1, 0), image(STREAM_COLOR, 1, 2)];
        assert!(pairing.pair(mixed).unwrap().is_err());
        let host = vec![image(STREAM_DEPTH, 2, 1), image(STREAM_COLOR, 2, 2)];
        assert!(pairing.pair(host).unwrap().is_ok());
        assert!(pairing.pair(vec![image(STREAM_COLOR, 3, 0)]).is_none());
    }
}

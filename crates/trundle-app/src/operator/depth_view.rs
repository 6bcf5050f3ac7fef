//! Depth of the camera's image, for views.

use std::sync::OnceLock;
use trundle_core::{DepthImage, PinholeCamera, Pose3, Stamp};
use trundle_io::decode_depth;

/// Depth of an image. The first front end that shows it decodes and thins it, in its own thread.
#[derive(Debug)]
pub struct DepthView {
    /// Time of the image.
    pub stamp: Stamp,
    encoded: Vec<u8>,
    picture: OnceLock<Option<DepthPicture>>,
}

impl DepthView {
    /// Depth in its recorded form.
    pub(crate) fn of_encoded(stamp: Stamp, depth: &[u8]) -> Self {
        Self { stamp, encoded: depth.to_vec(), picture: OnceLock::new() }
    }

    /// Depth of an image of a simulator.
    pub(crate) fn of(stamp: Stamp, depth: &DepthImage) -> Self {
        Self { stamp, encoded: Vec::new(), picture: OnceLock::from(Some(DepthPicture::of(depth))) }
    }

    /// The picture; `None` for depth that cannot be decoded.
    pub fn picture(&self) -> Option<&DepthPicture> {
        let decode = || decode_depth(&self.encoded).ok().map(|depth| DepthPicture::of(&depth));
        self.picture.get_or_init(decode).as_ref()
    }
}

/// Camera of a depth image, and its pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthViewpoint {
    /// The camera of the whole image.
    pub camera: PinholeCamera,
    /// `map_from_camera` at the stamp of the image; `None` if unknown.
    pub map_from_camera: Option<Pose3>,
}

/// A thinned depth image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DepthPicture {
    /// Pixels in a row.
    pub width: usize,
    /// Pixels of the depth image from one pixel of the picture to the next, in both directions.
    pub stride: usize,
    /// Depth of each pixel in [`DepthPicture::UNIT_M`], row by row; 0: not measured.
    pub pixels: Vec<u8>,
}

impl DepthPicture {
    /// Unit of depth \[m\]: up to 10.2 m. Source: ours; the depth cameras see less far.
    pub const UNIT_M: f64 = 0.04;
    /// Largest width \[px\]: an image of 20 kB. Source: ours.
    const MAX_WIDTH: usize = 160;

    /// Every second, third ... pixel of an image.
    #[must_use]
    pub fn of(depth: &DepthImage) -> Self {
        let stride = depth.width().div_ceil(Self::MAX_WIDTH).max(1);
        let unit = |depth: f32| if depth > 0.0 { (f64::from(depth) / Self::UNIT_M).ceil() as u8 } else { 0 };
        let rows = (0..depth.height()).step_by(stride).map(|y| depth.row(y));
        let pixels = rows.flat_map(|row| row.iter().step_by(stride).map(|depth| unit(*depth))).collect();
        Self { width: depth.width().div_ceil(stride), stride, pixels }
    }

    /// The camera of the picture, for the camera of the whole image; `None` if that camera has another image size.
    #[must_use]
    pub fn camera(&self, whole: &PinholeCamera) -> Option<PinholeCamera> {
        let size = (whole.width().div_ceil(self.stride), whole.height().div_ceil(self.stride));
        let scaled = |pixels: f64| pixels / self.stride as f64;
        let focal_lengths = (scaled(whole.fx()), scaled(whole.fy()));
        let centre = (scaled(whole.cx()), scaled(whole.cy()));
        let is_same_size = size.0 == self.width && size.0 * size.1 == self.pixels.len();
        let camera = || PinholeCamera::new(size, focal_lengths, centre, whole.distortion()).ok();
        is_same_size.then(camera)?
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Distortion, Vector2};
    use trundle_io::encode_depth_rvl;

    #[test]
    fn a_depth_image_is_thinned_and_keeps_what_was_not_measured() {
        let mut depth = DepthImage::filled(640, 480, 2.0);
        depth[(4, 0)] = 0.0;
        depth[(8, 0)] = 60.0;
        let picture = DepthPicture::of(&depth);
        assert_eq!((picture.width, picture.pixels.len()), (160, 160 * 120));
        assert_eq!(picture.pixels[..3], [50, 0, 255]);
        assert_eq!(DepthPicture::of(&DepthImage::filled(3, 2, 0.01)).pixels, [1; 6]);
    }

    #[test]
    fn the_camera_of_a_picture_sees_each_pixel_in_the_same_direction() {
        let lens = Distortion { k1: 0.09, k2: -0.27, ..Distortion::default() };
        let whole = PinholeCamera::new((642, 479), (520.0, 525.0), (318.6, 240.3), lens).unwrap();
        let picture = DepthPicture::of(&DepthImage::filled(642, 479, 2.0));
        let small = picture.camera(&whole).unwrap();
        assert_eq!((picture.width, small.height(), picture.stride), (129, 96, 5));
        let point = |camera: &PinholeCamera, x: f64, y: f64| {
            camera.unproject(camera.undistort(Vector2::new(x, y)), 2.0)
        };
        assert!((point(&small, 100.0, 20.0) - point(&whole, 500.0, 100.0)).norm() < 1e-9);
        assert_eq!(picture.camera(&PinholeCamera::kinect_v2()), None);
    }

    #[test]
    fn recorded_depth_is_decoded_and_broken_depth_has_no_picture() {
        let depth = DepthImage::filled(320, 240, 2.0);
        let encoded = encode_depth_rvl(&depth).unwrap();
        let view = DepthView::of_encoded(Stamp::default(), &encoded);
        assert_eq!(view.picture(), DepthView::of(Stamp::default(), &depth).picture());
        assert_eq!(view.picture().unwrap().pixels[0], 50);
        assert_eq!(DepthView::of_encoded(Stamp::default(), &encoded[..3]).picture(), None);
    }
}

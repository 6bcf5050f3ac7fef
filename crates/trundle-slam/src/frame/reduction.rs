//! Images of high resolution, reduced by a whole factor.

use std::borrow::Cow;
use trundle_core::{DepthImage, GrayImage, Invalid, PinholeCamera, Vector2};

/// Reduces images so that their longest side is within a limit. Search windows, numbers of features and standard deviations are in pixels
/// and those of images of about 640 x 480.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reduction {
    factor: usize,
    /// Columns and rows of the full image.
    full: (usize, usize),
}

impl Reduction {
    /// The smallest whole factor that brings the longest side of `camera`'s images to at most `max_side` px.
    pub fn of(camera: &PinholeCamera, max_side: usize) -> Self {
        let full = (camera.width(), camera.height());
        Self { factor: full.0.max(full.1).div_ceil(max_side.max(1)), full }
    }

    /// Side of the square of full pixels that one reduced pixel covers.
    pub fn factor(self) -> usize {
        self.factor
    }

    /// The camera of the reduced images.
    ///
    /// # Errors
    /// When the reduced principal point is outside the image.
    pub fn camera(self, camera: PinholeCamera) -> Result<PinholeCamera, Invalid> {
        if self.factor == 1 {
            return Ok(camera);
        }
        let factor = self.factor as f64;
        let centre = self.reduced(Vector2::new(camera.cx(), camera.cy()));
        let focal = (camera.fx() / factor, camera.fy() / factor);
        let size = (self.full.0 / self.factor, self.full.1 / self.factor);
        PinholeCamera::new(size, focal, (centre.x, centre.y), camera.distortion())?
            .with_readout(camera.readout())
    }

    /// The reduced grey image: means of squares. An image of another size than the camera's gives an empty one, which has no features.
    pub fn gray(self, full: GrayImage) -> GrayImage {
        if !self.is_full(&full) {
            return GrayImage::filled(0, 0, 0);
        }
        if self.factor == 1 {
            return full;
        }
        let Self { factor, full: (width, height) } = self;
        let half = (factor * factor / 2) as u32;
        GrayImage::from_fn(width / factor, height / factor, |x, y| {
            let rows = (y * factor..(y + 1) * factor).map(|row| &full.row(row)[x * factor..(x + 1) * factor]);
            let sum: u32 = rows.flatten().map(|value| u32::from(*value)).sum();
            ((sum + half) / (factor * factor) as u32) as u8
        })
    }

    /// The reduced depth image: one depth of each square, since means over an edge are depths of nothing.
    pub fn depth(self, full: &DepthImage) -> Cow<'_, DepthImage> {
        if self.factor == 1 || !self.is_full(full) {
            return Cow::Borrowed(full);
        }
        let Self { factor, full: (width, height) } = self;
        let middle = factor / 2;
        let pixel = |x: usize, y: usize| full.row(y * factor + middle)[x * factor + middle];
        Cow::Owned(DepthImage::from_fn(width / factor, height / factor, pixel))
    }

    /// Position in the full image of a position in the reduced one, px.
    pub fn enlarged(self, reduced: Vector2) -> Vector2 {
        reduced.map(|v| (v + 0.5) * self.factor as f64 - 0.5)
    }

    fn reduced(self, full: Vector2) -> Vector2 {
        full.map(|v| (v + 0.5) / self.factor as f64 - 0.5)
    }

    fn is_full<T>(self, image: &trundle_core::Image<T>) -> bool {
        (image.width(), image.height()) == self.full
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Distortion, Vector3};

    fn camera(width: usize, height: usize) -> PinholeCamera {
        let centre = (width as f64 / 2.0 - 3.0, height as f64 / 2.0 + 2.0);
        let lens = Distortion { k1: 0.1, k2: -0.05, ..Distortion::default() };
        PinholeCamera::new((width, height), (900.0, 910.0), centre, lens).unwrap()
    }

    #[test]
    fn images_within_the_limit_stay_and_others_get_the_smallest_factor() {
        let factor = |width, height| Reduction::of(&camera(width, height), 960).factor();
        assert_eq!([factor(640, 480), factor(848, 480), factor(960, 720)], [1, 1, 1]);
        assert_eq!([factor(1280, 720), factor(1920, 1080), factor(720, 1280)], [2, 2, 2]);
        assert_eq!(factor(3840, 2160), 4);
    }

    #[test]
    fn a_point_has_the_same_place_in_the_full_and_the_reduced_image() {
        let full = camera(1281, 721);
        let reduction = Reduction::of(&full, 640);
        let small = reduction.camera(full).unwrap();
        assert_eq!((reduction.factor(), small.width(), small.height()), (3, 427, 240));
        let point = Vector3::new(0.3, -0.2, 1.5);
        let [there, here] = [full, small].map(|camera| camera.distort(camera.project(point).unwrap()));
        assert!((reduction.enlarged(here) - there).norm() < 1e-9);
    }

    #[test]
    fn grey_is_averaged_and_depth_is_not() {
        let reduction = Reduction { factor: 2, full: (4, 2) };
        let gray = GrayImage::new(4, 2, vec![0, 10, 100, 100, 20, 30, 100, 101]).unwrap();
        assert_eq!(reduction.gray(gray).data(), &[15, 100]);
        let depth = DepthImage::new(4, 2, vec![1.0, 1.0, 2.0, 9.0, 1.0, 1.5, 2.0, 8.0]).unwrap();
        assert_eq!(reduction.depth(&depth).data(), &[1.5, 8.0]);
        assert_eq!(reduction.gray(GrayImage::filled(2, 1, 7)).width(), 0, "an image of another size");
    }
}

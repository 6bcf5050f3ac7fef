//! Rays of the pixels.

use trundle_core::{PinholeCamera, Vector2, Vector3};

/// The rays of a camera's pixels in the camera frame, row by row, without lens distortion: (u, v, 1) m at one m of depth.
#[derive(Debug, Clone)]
pub(super) struct LensRays {
    camera: PinholeCamera,
    u: Vec<f32>,
    v: Vec<f32>,
}

impl LensRays {
    pub(super) fn new(camera: PinholeCamera) -> Self {
        let width = camera.width();
        let pixel = |i: usize| ray_through(&camera, (i % width) as f64, (i / width) as f64);
        let (u, v) = (0..width * camera.height()).map(pixel).map(|ray| (ray.x as f32, ray.y as f32)).unzip();
        Self { camera, u, v }
    }

    /// The camera.
    pub(super) fn camera(&self) -> &PinholeCamera {
        &self.camera
    }

    /// Columns and rows of the image.
    pub(super) fn image_size(&self) -> (usize, usize) {
        (self.camera.width(), self.camera.height())
    }

    /// The u and the v of a row.
    pub(super) fn row(&self, y: usize) -> (&[f32], &[f32]) {
        let width = self.camera.width();
        let row = y * width..(y + 1) * width;
        (&self.u[row.clone()], &self.v[row])
    }

    /// The ray of pixel `i`, row by row.
    pub(super) fn ray(&self, i: usize) -> Vector3 {
        Vector3::new(f64::from(self.u[i]), f64::from(self.v[i]), 1.0)
    }

    /// Number of pixels.
    pub(super) fn len(&self) -> usize {
        self.u.len()
    }
}

/// The ray through a place of the image, its lens distortion undone.
pub(super) fn ray_through(camera: &PinholeCamera, x: f64, y: f64) -> Vector3 {
    camera.unproject(camera.undistort(Vector2::new(x, y)), 1.0)
}

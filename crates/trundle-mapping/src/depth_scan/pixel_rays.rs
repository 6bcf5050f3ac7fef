//! Rays of the pixels, and the fan of beams they fall into.

use trundle_core::{PinholeCamera, Pose3, Vector2, Vector3, wrap_angle};

/// The rays of a camera's pixels in its own frame, row by row: (u, v, 1) m at one m of depth, its lens distortion undone.
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

    /// How many pixels there are.
    pub(super) fn len(&self) -> usize {
        self.u.len()
    }
}

fn ray_through(camera: &PinholeCamera, x: f64, y: f64) -> Vector3 {
    camera.unproject(camera.undistort(Vector2::new(x, y)), 1.0)
}

/// The fan of beams that the pixels fall into. A pixel's bearing does not depend on its depth.
#[derive(Debug, Clone)]
pub(super) struct Fan {
    /// The beam of each pixel, row by row.
    pub(super) beam_of: Vec<u16>,
    pub(super) beams: usize,
    /// Bearing of the middle of beam 0, base frame, rad.
    pub(super) angle_min: f64,
    /// Between neighbouring beams, rad.
    pub(super) angle_increment: f64,
}

/// Maximum angle between neighbouring beams \[rad\]. It is reached by a camera that points straight down. Source: ours.
const MAX_BEAM_INCREMENT_RAD: f64 = 0.035;
/// Minimum angle between neighbouring beams \[rad\]. A full circle of beams is counted in 16 bits. Source: ours.
const MIN_BEAM_INCREMENT_RAD: f64 = 1e-4;

impl Fan {
    pub(super) fn new(lens: &LensRays, base_from_camera: &Pose3) -> Self {
        let forward = forward_bearing(base_from_camera);
        let base_from_lens = base_from_camera.rotation_matrix();
        let bearing = |ray: Vector3| {
            let d = base_from_lens * ray;
            wrap_angle(d.y.atan2(d.x) - forward)
        };
        let bearings: Vec<f64> = (0..lens.len()).map(|i| bearing(lens.ray(i))).collect();
        let (right, left) =
            bearings.iter().fold((f64::MAX, f64::MIN), |(lo, hi), b| (lo.min(*b), hi.max(*b)));

        let bearing_at = |x: f64, y: f64| bearing(ray_through(&lens.camera, x, y));
        let widest =
            widest_pixel(&lens.camera, bearing_at).clamp(MIN_BEAM_INCREMENT_RAD, MAX_BEAM_INCREMENT_RAD);
        let beams = (((left - right) / widest).floor() as usize).max(1);
        let angle_increment = ((left - right) / beams as f64).max(1e-5);
        let beam = |bearing: &f64| (((bearing - right) / angle_increment) as usize).min(beams - 1) as u16;
        let beam_of = bearings.iter().map(beam).collect();
        Self { beam_of, beams, angle_min: forward + right + angle_increment / 2.0, angle_increment }
    }
}

/// The greatest difference of bearing between neighbouring pixels, rad, in the middle of the image and of its sides: a
/// finer beam would fall between the columns.
fn widest_pixel(camera: &PinholeCamera, bearing: impl Fn(f64, f64) -> f64) -> f64 {
    let (right, bottom) = (camera.width() as f64 - 1.0, camera.height() as f64 - 1.0);
    let (cx, cy) = (right / 2.0, bottom / 2.0);
    let width_at = |(x, y): (f64, f64)| {
        let here = bearing(x, y);
        let step = |x, y| wrap_angle(bearing(x, y) - here).abs();
        step(x + 1.0, y).max(step(x, y + 1.0))
    };
    [(cx, cy), (cx, 0.0), (cx, bottom), (0.0, cy), (right, cy)].into_iter().map(width_at).fold(0.0, f64::max)
}

/// Bearing of the optical axis, base frame, rad; of the image's top where the camera points straight up or down.
fn forward_bearing(base_from_camera: &Pose3) -> f64 {
    let axis = base_from_camera.rotate(Vector3::z());
    let top = base_from_camera.rotate(-Vector3::y());
    let along = if axis.xy().norm() > 1e-3 { axis } else { top };
    along.y.atan2(along.x)
}

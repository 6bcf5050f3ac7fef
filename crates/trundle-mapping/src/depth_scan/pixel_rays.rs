use trundle_core::{PinholeCamera, Pose3, Vector2, Vector3, wrap_angle};

/// Where a pixel's ray goes for each metre of depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PixelRay {
    /// Way over the floor, m for each m of depth.
    pub(super) run: f32,
    /// Climb, m for each m of depth.
    pub(super) rise: f32,
    /// The beam of the scan that it belongs to: its bearing does not depend on depth.
    pub(super) beam: u32,
    /// Where the ray leaves the height band upward, m over the floor; 0 when it does not.
    pub(super) exit: f32,
}

impl PixelRay {
    /// A ray of a camera that is `headroom` m below the band's upper edge.
    pub(super) fn new(run: f32, rise: f32, beam: u32, headroom: f32) -> Self {
        let exit = if rise > 0.0 && headroom > 0.0 { headroom * run / rise } else { 0.0 };
        Self { run, rise, beam, exit }
    }
}

/// The rays of a camera's pixels in its own frame, row by row, one m deep, its lens distortion undone.
#[derive(Debug, Clone)]
pub(super) struct LensRays {
    camera: PinholeCamera,
    rays: Vec<Vector3>,
}

impl LensRays {
    pub(super) fn new(camera: PinholeCamera) -> Self {
        let width = camera.width();
        let pixel = |i: usize| ray_through(&camera, (i % width) as f64, (i / width) as f64);
        Self { rays: (0..width * camera.height()).map(pixel).collect(), camera }
    }

    /// Columns and rows of the image.
    pub(super) fn image_size(&self) -> (usize, usize) {
        (self.camera.width(), self.camera.height())
    }
}

fn ray_through(camera: &PinholeCamera, x: f64, y: f64) -> Vector3 {
    camera.unproject(camera.undistort(Vector2::new(x, y)), 1.0)
}

/// The rays of all pixels, row by row, and the fan of beams that they fall into.
#[derive(Debug, Clone)]
pub(super) struct PixelRays {
    pub(super) rays: Vec<PixelRay>,
    pub(super) beams: usize,
    /// Bearing of the middle of beam 0, base frame, rad.
    pub(super) angle_min: f64,
    /// Between neighbouring beams, rad.
    pub(super) angle_increment: f64,
}

/// Coarsest beam, rad: for a camera that looks straight down, whose pixels have no bearing of their own.
const COARSEST_BEAM: f64 = 0.035;

impl PixelRays {
    /// The rays of a camera at `base_from_camera`, for a band up to `band_high` m.
    pub(super) fn new(lens: &LensRays, base_from_camera: &Pose3, band_high: f64) -> Self {
        let forward = forward_bearing(base_from_camera);
        let base_from_lens = base_from_camera.rotation_matrix();
        let bearing = |d: &Vector3| wrap_angle(d.y.atan2(d.x) - forward);
        let directions: Vec<(Vector3, f64)> =
            lens.rays.iter().map(|ray| base_from_lens * ray).map(|d| (d, bearing(&d))).collect();
        let fan = directions.iter().map(|(_, bearing)| *bearing);
        let (right, left) = fan.fold((f64::MAX, f64::MIN), |(lo, hi), b| (lo.min(b), hi.max(b)));

        let bearing_at = |x: f64, y: f64| bearing(&(base_from_lens * ray_through(&lens.camera, x, y)));
        let widest = widest_pixel(&lens.camera, bearing_at).clamp(1e-5, COARSEST_BEAM);
        let beams = (((left - right) / widest).floor() as usize).max(1);
        let angle_increment = ((left - right) / beams as f64).max(1e-5);

        let headroom = (band_high - base_from_camera.translation.z) as f32;
        let beam = |bearing: f64| (((bearing - right) / angle_increment) as usize).min(beams - 1) as u32;
        let ray = |(d, bearing): &(Vector3, f64)| {
            PixelRay::new(d.xy().norm() as f32, d.z as f32, beam(*bearing), headroom)
        };
        let rays = directions.iter().map(ray).collect();
        Self { rays, beams, angle_min: forward + right + angle_increment / 2.0, angle_increment }
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

/// The bearing in which the camera looks, base frame, rad; when it looks straight up or down, that of the image's top.
fn forward_bearing(base_from_camera: &Pose3) -> f64 {
    let axis = base_from_camera.rotate(Vector3::z());
    let top = base_from_camera.rotate(-Vector3::y());
    let along = if axis.xy().norm() > 1e-3 { axis } else { top };
    along.y.atan2(along.x)
}

//! A tiny world of boxes on a floor, seen by a depth camera: analytic, for comparing ranges.

use trundle_core::{ColorImage, DepthImage, PinholeCamera, Pose3, RgbdImage, Stamp, Vector2, Vector3};

/// An axis-aligned box, base frame, m.
#[derive(Debug, Clone, Copy)]
pub struct Solid {
    pub low: Vector3,
    pub high: Vector3,
}

impl Solid {
    pub fn new(low: [f64; 3], high: [f64; 3]) -> Self {
        Self { low: low.into(), high: high.into() }
    }

    /// A wall across the path, `x` m ahead, of this height.
    pub fn wall(x: f64, height: f64) -> Self {
        Self::new([x, -20.0, 0.0], [x + 0.1, 20.0, height])
    }

    /// Distance along the ray, in units of `direction`.
    fn hit(&self, from: Vector3, direction: Vector3) -> Option<f64> {
        let (mut enter, mut exit) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let inverse = 1.0 / direction[axis];
            let (a, b) = ((self.low[axis] - from[axis]) * inverse, (self.high[axis] - from[axis]) * inverse);
            enter = enter.max(a.min(b));
            exit = exit.min(a.max(b));
        }
        (enter < exit && enter > 0.0).then_some(enter)
    }
}

/// The camera `height` m above the base, looking ahead and down by `tilt_deg`.
pub fn mount(height: f64, tilt_deg: f64) -> Pose3 {
    mounted([0.05, 0.0, height], 0.0, tilt_deg, 0.0)
}

/// A camera anywhere: position (m), turn to the left, tilt down and roll (deg).
pub fn mounted(position: [f64; 3], yaw_deg: f64, tilt_deg: f64, roll_deg: f64) -> Pose3 {
    let body_from_optical = nalgebra::Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
    let turn = nalgebra::Rotation3::from_euler_angles(
        roll_deg.to_radians(),
        tilt_deg.to_radians(),
        yaw_deg.to_radians(),
    );
    Pose3::from_matrix(turn.into_inner() * body_from_optical, position.into())
}

/// The depth image of `solids` on a floor of height 0, m; 0 for a ray without a surface within 12 m.
pub fn depth_of(
    camera: &PinholeCamera,
    base_from_camera: &Pose3,
    solids: &[Solid],
    floor: bool,
) -> DepthImage {
    let from = base_from_camera.translation;
    DepthImage::from_fn(camera.width(), camera.height(), |x, y| {
        let pixel = camera.undistort(Vector2::new(x as f64, y as f64));
        let direction = base_from_camera.rotate(camera.unproject(pixel, 1.0));
        let ground = (floor && direction.z < 0.0).then(|| -from.z / direction.z);
        let nearest =
            solids.iter().filter_map(|s| s.hit(from, direction)).chain(ground).fold(f64::INFINITY, f64::min);
        if nearest < 12.0 { nearest as f32 } else { 0.0 }
    })
}

/// Noise of a depth camera: 3 mm + 1.5 mm/m^2 z^2, from a hash of the pixel.
pub fn add_noise(depth: &mut DepthImage, seed: u64) {
    for (i, z) in depth.data_mut().iter_mut().enumerate() {
        let uniform = |k: u64| (mix(seed ^ (i as u64 * 4 + k)) >> 11) as f64 / (1_u64 << 53) as f64;
        let normal = (-2.0 * (uniform(0) + 1e-300).ln()).sqrt() * (std::f64::consts::TAU * uniform(1)).cos();
        *z += (normal * (0.003 + 0.0015 * f64::from(*z * *z))) as f32;
    }
}

/// SplitMix64.
pub fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

/// An RGB-D image of this depth.
pub fn rgbd(depth: DepthImage) -> RgbdImage {
    let color = ColorImage::filled(depth.width(), depth.height(), [0; 3]);
    RgbdImage::new(Stamp::from_nanos(7), color, depth).unwrap()
}

//! A box of textured walls, ray cast, with a little noise: shares only trundle-core with what it evaluates.

use trundle_core::{ColorImage, DepthImage, Image, PinholeCamera, Pose3, RgbdImage, Stamp, Vector2, Vector3};

/// Half the size of the room along x, y, z, m.
const HALF: Vector3 = Vector3::new(2.2, 1.4, 2.6);

/// A camera small enough to render quickly.
pub fn camera() -> PinholeCamera {
    PinholeCamera::from_field_of_view((320, 240), (68_f64.to_radians(), 53_f64.to_radians())).unwrap()
}

/// View of the camera at `room_from_camera`, as frame `number` of a 30 Hz stream.
pub fn shoot(number: usize, room_from_camera: Pose3) -> RgbdImage {
    Clean::at(room_from_camera).shot(number)
}

/// A view without noise.
pub struct Clean {
    shade: Image<f64>,
    depth: Image<f64>,
}

impl Clean {
    pub fn at(room_from_camera: Pose3) -> Self {
        let camera = camera();
        let hit = |x: f64, y: f64| hit(&camera, room_from_camera, x, y);
        let shade = |x: usize, y: usize| {
            let samples = [(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)];
            samples.iter().map(|(dx, dy)| hit(x as f64 + dx, y as f64 + dy).1).sum::<f64>() / 4.0
        };
        let (width, height) = (camera.width(), camera.height());
        let depth = Image::from_fn(width, height, |x, y| hit(x as f64, y as f64).0);
        Self { shade: Image::from_fn(width, height, shade), depth }
    }

    /// The view with the noise of frame `number`.
    pub fn shot(&self, number: usize) -> RgbdImage {
        let (width, height) = (self.depth.width(), self.depth.height());
        let noise =
            |x: usize, y: usize, kind: u64| uniform(hash(&[number as u64, x as u64, y as u64, kind])) - 0.5;
        let gray = |x: usize, y: usize| (self.shade[(x, y)] + 8.0 * noise(x, y, 0)).clamp(0.0, 255.0) as u8;
        let depth = |x: usize, y: usize| (self.depth[(x, y)] * (1.0 + 0.01 * noise(x, y, 1))) as f32;
        let color = ColorImage::from_fn(width, height, |x, y| [gray(x, y); 3]);
        RgbdImage::new(stamp(number), color, DepthImage::from_fn(width, height, depth)).unwrap()
    }
}

pub fn stamp(number: usize) -> Stamp {
    Stamp::from_nanos(1_000_000_000 + number as i64 * 33_333_333)
}

/// Depth along the optical axis (m) and shade (0 to 255) at a pixel.
fn hit(camera: &PinholeCamera, pose: Pose3, x: f64, y: f64) -> (f64, f64) {
    let ray = pose.rotate(camera.unproject(Vector2::new(x, y), 1.0));
    let wall = |axis: usize| (ray[axis].signum() * HALF[axis] - pose.translation[axis]) / ray[axis];
    let axis = (0..3).min_by(|a, b| wall(*a).total_cmp(&wall(*b))).unwrap();
    let depth = wall(axis);
    let at = pose.translation + ray * depth;
    let (u, v) = (at[(axis + 1) % 3], at[(axis + 2) % 3]);
    (depth, texture(axis as u64 * 2 + u64::from(ray[axis] > 0.0), u, v))
}

/// Random tiles of three sizes, one over the other.
fn texture(wall: u64, u: f64, v: f64) -> f64 {
    [(0.31, 110.0), (0.13, 80.0), (0.057, 60.0)]
        .iter()
        .map(|(size, weight)| {
            let cell = |c: f64| (c / size + 1000.3).floor() as u64;
            weight * uniform(hash(&[wall, cell(u), cell(v), (size * 1e3) as u64]))
        })
        .sum()
}

fn hash(words: &[u64]) -> u64 {
    words.iter().fold(0x9E37_79B9_7F4A_7C15, |h, w| {
        let mixed = (h ^ w).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        (mixed ^ (mixed >> 29)).wrapping_mul(0x94D0_49BB_1331_11EB) ^ (mixed >> 32)
    })
}

/// 0 to 1.
fn uniform(hash: u64) -> f64 {
    (hash >> 11) as f64 / (1u64 << 53) as f64
}

//! A room of points, observed with exactly the noise of the configuration. Without images and feature extraction many runs are cheap, and
//! only the estimator is evaluated.

use nalgebra::Vector6;
use trundle_core::{DepthImage, PinholeCamera, Pose3, Stamp, Vector2, Vector3};
use trundle_slam::SlamConfig;
use trundle_vision::{Descriptor, Features, Keypoint, OrbConfig};

/// Half the size of the room along x, y, z, m.
const HALF: Vector3 = Vector3::new(2.2, 1.4, 2.6);
/// Points on its walls.
const POINTS: u64 = 7000;
/// Bits of a descriptor that differ between two views.
const FLIPPED: usize = 10;
/// Scale factor between octaves.
const SCALE: f64 = 1.2;

/// Random numbers of one run (SplitMix64).
pub struct Dice(pub u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// 0 to 1.
    pub fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// With mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

pub fn camera() -> PinholeCamera {
    PinholeCamera::from_field_of_view((320, 240), (68_f64.to_radians(), 53_f64.to_radians())).unwrap()
}

/// The room.
pub struct Room {
    points: Vec<Point>,
}

struct Point {
    position: Vector3,
    inward: Vector3,
    descriptor: Descriptor,
    /// Distance of the view at octave 0, m.
    distance_at_octave_0: f64,
}

impl Room {
    pub fn new() -> Self {
        let mut dice = Dice(77);
        let point = |i: u64| {
            let axis = (i % 3) as usize;
            let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            let mut position = HALF.map(|half| half * (2.0 * dice.uniform() - 1.0));
            position[axis] = side * HALF[axis];
            let inward = Vector3::ith(axis, -side);
            let descriptor = Descriptor(std::array::from_fn(|_| dice.next()));
            Point { position, inward, descriptor, distance_at_octave_0: 1.5 + 4.0 * dice.uniform() }
        };
        Self { points: (0..POINTS).map(point).collect() }
    }

    /// View of a camera: features and depth image, with noise.
    pub fn seen_from(&self, room_from_camera: Pose3, dice: &mut Dice) -> (Features, DepthImage) {
        let (camera, config) = (camera(), SlamConfig::default());
        let camera_from_room = room_from_camera.inverse();
        let mut depth = DepthImage::filled(camera.width(), camera.height(), 0.0);
        let mut features = Features::default();
        for point in &self.points {
            let p = camera_from_room.transform(point.position);
            let ray = room_from_camera.translation - point.position;
            let octave = (point.distance_at_octave_0 / ray.norm()).ln() / SCALE.ln();
            if ray.dot(&point.inward) < 0.3 * ray.norm() || !(-0.5..7.4).contains(&octave) {
                continue;
            }
            let sigma = config.tracking.pixel_sigma * SCALE.powi(octave.round() as i32);
            let Some(pixel) = camera.project(p) else { continue };
            let pixel = pixel + Vector2::new(dice.normal(), dice.normal()) * sigma;
            let measured = p.z + config.depth.sigma_at(p.z) * dice.normal();
            if set_patch(&mut depth, pixel, measured) && is_describable(pixel, octave.round() as i32) {
                let (x, y) = (pixel.x as f32, pixel.y as f32);
                let keypoint = Keypoint { x, y, octave: octave.round() as u8, angle: 0.0, response: 1.0 };
                features.keypoints.push(keypoint);
                features.descriptors.push(flipped(point.descriptor, dice));
            }
        }
        (features, depth)
    }
}

/// Whether the surroundings of a pixel suffice for an ORB descriptor.
fn is_describable(pixel: Vector2, octave: i32) -> bool {
    let (camera, margin) = (camera(), OrbConfig::MARGIN as f64 * SCALE.powi(octave));
    let is_within = |v: f64, side: usize| (margin..=side as f64 - 1.0 - margin).contains(&v);
    is_within(pixel.x, camera.width()) && is_within(pixel.y, camera.height())
}

/// An image without features.
pub fn darkness() -> (Features, DepthImage) {
    let camera = camera();
    (Features::default(), DepthImage::filled(camera.width(), camera.height(), 0.0))
}

pub fn stamp(number: usize) -> Stamp {
    Stamp::from_nanos(1_000_000_000 + number as i64 * 33_333_333)
}

/// A motion by the wheels, with the noise of the configuration.
pub fn reported(motion: Pose3, config: &SlamConfig, dice: &mut Dice) -> Pose3 {
    let (off, turned) = config.motion.sigmas(motion, 1.0 / 30.0);
    let noise = Vector6::from_fn(|i, _| dice.normal() * if i < 3 { off } else { turned });
    motion * Pose3::exp(noise)
}

/// Sets the depth around a pixel, unless something else is there already or it is too near the border.
fn set_patch(depth: &mut DepthImage, pixel: Vector2, value: f64) -> bool {
    let (x, y) = (pixel.x.round(), pixel.y.round());
    let inside = x >= 3.0 && y >= 3.0 && x < depth.width() as f64 - 3.0 && y < depth.height() as f64 - 3.0;
    if !inside {
        return false;
    }
    let (x, y) = (x as usize, y as usize);
    let cells = || (y - 1..=y + 1).flat_map(move |row| (x - 1..=x + 1).map(move |column| (column, row)));
    if cells().any(|cell| depth[cell] > 0.0) {
        return false;
    }
    cells().for_each(|cell| depth[cell] = value as f32);
    true
}

fn flipped(mut descriptor: Descriptor, dice: &mut Dice) -> Descriptor {
    for _ in 0..FLIPPED {
        let bit = dice.next() % 256;
        descriptor.0[(bit / 64) as usize] ^= 1 << (bit % 64);
    }
    descriptor
}

//! Recorded sequences in the TUM layout, as the tests and examples of this crate read them.

#![allow(dead_code, reason = "each program uses a part of it")]

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion};
use std::path::{Path, PathBuf};
use trundle_core::{
    CameraMotion, ColorImage, DepthImage, Distortion, Hypotenuse, PinholeCamera, Pose2, Pose3, RgbdImage,
    Stamp, Vector3,
};

/// A folder of images: of the simulator (with `camera.toml` and, on wheels, `odometry.txt`), or else of the TUM benchmark's
/// freiburg1.
pub struct Drive {
    folder: PathBuf,
    pub camera: PinholeCamera,
    depth_scale: f32,
    pub frames: Vec<DriveFrame>,
}

/// One image and its data.
pub struct DriveFrame {
    pub stamp: Stamp,
    color: String,
    depth: String,
    /// `world_from_camera`; `None` if the truth has a gap.
    pub truth: Option<Pose3>,
    /// Pose of the base by the wheels.
    wheels: Option<Pose3>,
}

impl Drive {
    /// Reads the lists of a folder, not yet the images.
    pub fn open(folder: impl AsRef<Path>) -> Self {
        let folder = folder.as_ref().to_owned();
        let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap_or_default();
        let (truth, wheels) = (truth(&read("groundtruth.txt")), wheels(&read("odometry.txt")));
        let list = read("associations.txt");
        let frame = |line: &str| {
            let fields: Vec<&str> = line.split_whitespace().collect();
            let seconds: f64 = fields[0].parse().unwrap();
            let (color, depth) = (fields[1].to_owned(), fields[3].to_owned());
            let stamp = Stamp::from_secs(seconds).unwrap();
            DriveFrame { stamp, color, depth, truth: at(&truth, seconds), wheels: at(&wheels, seconds) }
        };
        let frames = list.lines().filter(|line| !line.starts_with('#')).map(frame).collect();
        let (camera, depth_scale, readout) = match read("camera.toml") {
            text if text.is_empty() => (freiburg1(), 5000.0, 0.026),
            text => (camera(&text), setting(&text, "depth_scale") as f32, setting(&text, "readout")),
        };
        Self { folder, camera: camera.with_readout(readout).unwrap(), depth_scale, frames }
    }

    /// The image of frame `i`.
    pub fn image(&self, i: usize) -> RgbdImage {
        let frame = &self.frames[i];
        let color = image::open(self.folder.join(&frame.color)).unwrap().to_rgb8();
        let depth = image::open(self.folder.join(&frame.depth)).unwrap().to_luma16();
        let (width, height) = (color.width() as usize, color.height() as usize);
        let color = ColorImage::new(width, height, color.pixels().map(|p| p.0).collect()).unwrap();
        let depth = depth.into_raw().into_iter().map(|v| f32::from(v) / self.depth_scale).collect();
        RgbdImage::new(frame.stamp, color, DepthImage::new(width, height, depth).unwrap()).unwrap()
    }

    /// `previous_camera_from_camera` by the wheels, for the camera as the simulator mounts it: 5 cm forward, tilted by 8 deg.
    pub fn wheels(&self, i: usize) -> Option<CameraMotion> {
        let motion = self.frames[i.checked_sub(1)?].wheels?.inverse() * self.frames[i].wheels?;
        let axes = Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
        let tilt = Rotation3::from_euler_angles(0.0, 8_f64.to_radians(), 0.0);
        let base_from_camera = Pose3::from_matrix(tilt.into_inner() * axes, Vector3::new(0.05, 0.0, 0.45));
        let motion = motion.to_pose2();
        Some(CameraMotion::of_base((motion, noise(&motion)), base_from_camera))
    }

    /// True pose of the camera of frame `i`.
    pub fn truth(&self, i: usize) -> Pose3 {
        self.frames[i].truth.unwrap()
    }
}

/// Noise of wheels without a gyro, as in `OdometryConfig` of trundle-estimation.
fn noise(motion: &Pose2) -> Matrix3<f64> {
    let (distance, turn) = (motion.x.hypotenuse(motion.y), motion.theta.abs());
    let spot = 0.002_f64.powi(2) * turn;
    let heading = 0.05_f64.powi(2) * turn + 0.02_f64.powi(2) * distance;
    Matrix3::from_diagonal(&Vector3::new(
        0.02_f64.powi(2) * distance + spot,
        0.001_f64.powi(2) * distance + spot,
        heading,
    ))
}

/// The camera of the TUM benchmark's freiburg1.
pub fn freiburg1() -> PinholeCamera {
    let lens = Distortion { k1: 0.2624, k2: -0.9531, p1: -0.0054, p2: 0.0026, k3: 1.1633 };
    PinholeCamera::new((640, 480), (517.3, 516.5), (318.6, 255.3), lens).unwrap()
}

fn camera(text: &str) -> PinholeCamera {
    let setting = |name: &str| setting(text, name);
    let lens = Distortion {
        k1: setting("k1"),
        k2: setting("k2"),
        p1: setting("p1"),
        p2: setting("p2"),
        k3: setting("k3"),
    };
    let size = (setting("width") as usize, setting("height") as usize);
    PinholeCamera::new(size, (setting("fx"), setting("fy")), (setting("cx"), setting("cy")), lens).unwrap()
}

/// A number of `camera.toml`, 0 if it is not named.
fn setting(text: &str, name: &str) -> f64 {
    let line = text.lines().find_map(|line| line.split_once('=').filter(|(key, _)| key.trim() == name));
    line.map_or(0.0, |(_, value)| value.trim().parse().unwrap())
}

/// The pose at a time, between the two nearest ones if these are less than 0.1 s apart.
fn at(poses: &[(f64, Pose3)], seconds: f64) -> Option<Pose3> {
    let after = poses.partition_point(|(t, _)| *t < seconds - 1e-6);
    let (b, to) = poses.get(after)?;
    if b - seconds < 1e-6 {
        return Some(*to);
    }
    let (a, from) = poses.get(after.checked_sub(1)?)?;
    let part = (seconds - a) / (b - a);
    (b - a < 0.1).then(|| *from * Pose3::exp((from.inverse() * *to).log() * part))
}

/// Time (s) and planar pose of each line.
fn wheels(text: &str) -> Vec<(f64, Pose3)> {
    let pose = |v: &[f64]| Pose3::from_pose2(Pose2::new(v[1], v[2], v[3]));
    numbers(text).map(|v| (v[0], pose(&v))).collect()
}

/// Time (s) and pose of each line.
fn truth(text: &str) -> Vec<(f64, Pose3)> {
    let rotation = |v: &[f64]| UnitQuaternion::from_quaternion(Quaternion::new(v[7], v[4], v[5], v[6]));
    numbers(text).map(|v| (v[0], Pose3::new(rotation(&v), Vector3::new(v[1], v[2], v[3])))).collect()
}

/// The numbers of each line that is not a comment.
fn numbers(text: &str) -> impl Iterator<Item = Vec<f64>> + '_ {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split_whitespace().map(|v| v.parse().unwrap()).collect())
}

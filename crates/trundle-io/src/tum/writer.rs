//! Writer of an RGB-D sequence in the TUM format.

use super::{TumFrame, odometry_text, orb_slam_yaml, trajectory_text};
use crate::{CameraModel, IoError, OutputFolder, TUM_DEPTH_SCALE};
use std::fmt::Write;
use trundle_core::{PinholeCamera, Pose2, Pose3, Stamp};

/// Writes a TUM RGB-D folder that [`crate::TumSequence`], evo and ORB-SLAM programs read directly.
///
/// Images are written immediately; the lists, ground truth, odometry and calibration at [`TumWriter::finish`], each sorted by stamp. Names
/// of images sort like their stamps.
#[derive(Debug)]
pub struct TumWriter<'f> {
    folder: &'f OutputFolder,
    camera: PinholeCamera,
    rate_hz: f64,
    frames: Vec<Stamp>,
    ground_truth: Vec<(Stamp, Pose3)>,
    odometry: Vec<(Stamp, Pose2)>,
}

impl<'f> TumWriter<'f> {
    /// Writes the images of `camera` into `folder`, nominally at `rate_hz`, which ORB-SLAM requires.
    pub fn new(folder: &'f OutputFolder, camera: PinholeCamera, rate_hz: f64) -> Self {
        let (frames, ground_truth, odometry) = Default::default();
        Self { folder, camera, rate_hz, frames, ground_truth, odometry }
    }

    /// Writes an image, `rgb/STAMP.png` and `depth/STAMP.png`.
    ///
    /// # Errors
    /// When the size differs from the camera's, an image with the same stamp exists, or a file cannot be written.
    pub fn frame(&mut self, frame: &TumFrame) -> Result<(), IoError> {
        let name = file_name("rgb", frame.stamp);
        let expected = (self.camera.width(), self.camera.height());
        let problem = if frame.size != expected {
            let ((w, h), (cw, ch)) = (frame.size, expected);
            Some(format!("image is {w} x {h} px, expected {cw} x {ch} as the camera"))
        } else {
            let twice = self.frames.contains(&frame.stamp);
            twice.then(|| format!("a second image at {} s, expected stamps that differ", frame.stamp))
        };
        if let Some(problem) = problem {
            return Err(IoError::malformed(&self.folder.target().join(name), problem));
        }
        let depth = file_name("depth", frame.stamp);
        self.folder.write(&name, &frame.color_png)?;
        self.folder.write(&depth, &frame.depth_png)?;
        // A frame that the disk did not take is in no list.
        let is_whole = self.folder.holds(&name) && self.folder.holds(&depth);
        self.frames.extend(is_whole.then_some(frame.stamp));
        Ok(())
    }

    /// Adds the true camera pose, `world_from_camera`, of the optical frame (x right, y down, z ahead).
    pub fn ground_truth(&mut self, stamp: Stamp, world_from_camera: Pose3) {
        self.ground_truth.push((stamp, world_from_camera));
    }

    /// Adds the pose of the base by the wheels, `odom_from_base`.
    pub fn odometry(&mut self, stamp: Stamp, odom_from_base: Pose2) {
        self.odometry.push((stamp, odom_from_base));
    }

    /// Writes the lists, `groundtruth.txt` and `odometry.txt` (if not empty), `camera.toml` and `orb_slam.yaml`.
    ///
    /// # Errors
    /// When no image was written, or a file cannot be written.
    pub fn finish(mut self) -> Result<(), IoError> {
        if self.frames.is_empty() && self.folder.is_incomplete() {
            return Ok(()); // the disk took none: the commit names it
        }
        if self.frames.is_empty() {
            return Err(IoError::malformed(self.folder.target(), "no image to write, expected 1 or more"));
        }
        self.frames.sort_unstable();
        let write = |name: &str, text: String| self.folder.write(name, text.as_bytes());
        let titled = |folder| format!("# timestamp filename\n{}", list(&self.frames, &[folder]));
        write("rgb.txt", titled("rgb"))?;
        write("depth.txt", titled("depth"))?;
        write("associations.txt", list(&self.frames, &["rgb", "depth"]))?; // ORB-SLAM does not accept comments in this file
        if !self.ground_truth.is_empty() {
            write("groundtruth.txt", trajectory_text(&by_stamp(self.ground_truth)))?;
        }
        if !self.odometry.is_empty() {
            write("odometry.txt", odometry_text(&by_stamp(self.odometry)))?;
        }
        let model = CameraModel { camera: self.camera, depth_scale: TUM_DEPTH_SCALE };
        write("camera.toml", model.to_toml())?;
        write("orb_slam.yaml", orb_slam_yaml(&model, self.rate_hz))
    }
}

/// The poses by rising stamp; of equal stamps the first pose.
fn by_stamp<T>(mut poses: Vec<(Stamp, T)>) -> Vec<(Stamp, T)> {
    poses.sort_by_key(|(stamp, _)| *stamp);
    poses.dedup_by_key(|(stamp, _)| *stamp);
    poses
}

/// Seconds are padded, so names sort like stamps in any program that lists the folder.
fn file_name(folder: &str, stamp: Stamp) -> String {
    format!("{folder}/{:0>20}.png", stamp.to_string())
}

fn list(frames: &[Stamp], folders: &[&str]) -> String {
    let mut text = String::new();
    for &stamp in frames {
        let columns = folders.iter().map(|folder| format!("{stamp} {}", file_name(folder, stamp)));
        writeln!(text, "{}", columns.collect::<Vec<_>>().join(" "))
            .expect("invariant: a String takes any text");
    }
    text
}

//! Reader of an RGB-D sequence in the TUM format.

use super::list::ListedImage;
use super::members::Members;
use super::odometry::read_optional_odometry;
use super::trajectory::read_optional_trajectory;
use crate::camera::checked_depth_scale;
use crate::codec::{decode_color, decode_depth_file};
use crate::files::read_bytes;
use crate::{FrameError, IoError, Warnings};
use std::path::{Path, PathBuf};
use trundle_core::{Pose2, Pose3, RgbdImage, Stamp, require_finite};

/// A recorded RGB-D sequence in TUM's form, its images still on disk.
///
/// The folder contains `rgb.txt` and `depth.txt` (lines of `timestamp filename`), or `associations.txt` alone, and their images. Colour is
/// PNG or JPEG; depth is registered to colour, with 16 bits, or 32-bit floats in metres. Optional files are `groundtruth.txt` (a
/// trajectory) and `odometry.txt` (lines of `timestamp x y theta`, or of a TUM trajectory).
#[derive(Debug, Clone)]
pub struct TumSequence {
    dir: PathBuf,
    depth_scale: f64,
    size: Option<(usize, usize)>,
    frames: Vec<(ListedImage, ListedImage)>,
    unpaired: usize,
    listed: usize,
    ground_truth: Option<Vec<(Stamp, Pose3)>>,
    odometry: Option<Vec<(Stamp, Pose2)>>,
    warnings: Warnings,
}

impl TumSequence {
    /// Largest time difference between the colour and the depth image of a frame, s: 0.02. Source: TUM's `associate.py`.
    pub const MAX_DIFFERENCE: f64 = 0.02;

    /// Opens a folder: reads its lists and pairs each colour image with the depth image nearest in time, at most `max_difference` s apart.
    /// `depth_scale` is the number of a depth of 1 m in the depth images (5000 for TUM).
    ///
    /// # Errors
    /// When the folder or a list is missing, a line is wrong, no images can be paired, or the depth scale is invalid.
    pub fn open(dir: &Path, depth_scale: f64, max_difference: f64) -> Result<Self, IoError> {
        let checked = checked_depth_scale(depth_scale)
            .and_then(|_| require_finite("max_difference", max_difference, "s"));
        checked.map_err(IoError::field(dir))?;
        let Members { frames, unpaired, listed, mut warnings } = Members::read(dir, max_difference)?;
        let ground_truth = ground_truth(dir, &frames, &mut warnings);
        let odometry = odometry(dir, &mut warnings)?;
        Ok(Self {
            dir: dir.to_owned(),
            depth_scale,
            size: None,
            frames,
            unpaired,
            listed,
            ground_truth,
            odometry,
            warnings,
        })
    }

    /// Corrections and omissions on opening, one warning a kind.
    pub fn warnings(&self) -> &Warnings {
        &self.warnings
    }

    /// Accepts from now on only images of `width` x `height` px, the camera's.
    pub fn with_size(mut self, width: usize, height: usize) -> Self {
        self.size = Some((width, height));
        self
    }

    /// Decodes depth from now on by `depth_scale`, units per metre.
    pub fn with_depth_scale(mut self, depth_scale: f64) -> Self {
        self.depth_scale = depth_scale;
        self
    }

    /// The number of frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether the sequence is empty; always false.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Number of colour images without a near enough depth image, which are left out.
    pub fn unpaired(&self) -> usize {
        self.unpaired
    }

    /// Number of listed colour images, including those left out.
    pub fn listed(&self) -> usize {
        self.listed
    }

    /// The stamp of frame `i`, that of its colour image. Panics for an index beyond the last frame.
    pub fn stamp(&self, i: usize) -> Stamp {
        self.frames[i].0.stamp
    }

    /// `world_from_camera` by motion capture, if the folder has it.
    pub fn ground_truth(&self) -> Option<&[(Stamp, Pose3)]> {
        self.ground_truth.as_deref()
    }

    /// `odom_from_base`, if the folder has it.
    pub fn odometry(&self) -> Option<&[(Stamp, Pose2)]> {
        self.odometry.as_deref()
    }

    /// Reads and decodes frame `i`; depth becomes metres. Panics beyond the last.
    ///
    /// # Errors
    /// When one of the frame's files is missing, truncated, of a wrong kind or size: the caller may continue with the next frame.
    pub fn load(&self, i: usize) -> Result<RgbdImage, FrameError> {
        let (color, depth) = &self.frames[i];
        self.image(color, depth).map_err(|source| FrameError { index: i, stamp: color.stamp, source })
    }

    /// All frames in order; broken frames are errors.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = Result<RgbdImage, FrameError>> + '_ {
        (0..self.len()).map(|i| self.load(i))
    }

    fn image(&self, color: &ListedImage, depth: &ListedImage) -> Result<RgbdImage, IoError> {
        let (color_path, depth_path) = (self.dir.join(&color.file), self.dir.join(&depth.file));
        let pixels = decode_color(&read_bytes(&color_path)?).map_err(IoError::image(&color_path))?;
        let found = (pixels.width(), pixels.height());
        if let Some(size) = self.size.filter(|size| *size != found) {
            return Err(IoError::wrong_image_size(&color_path, found, size));
        }
        let metres = decode_depth_file(&read_bytes(&depth_path)?, self.depth_scale)
            .map_err(IoError::image(&depth_path))?;
        RgbdImage::of_registered(color.stamp, pixels, metres).map_err(IoError::field(&depth_path))
    }
}

/// The ground truth; `None` without its file. Poses without times get the stamps of the images if their numbers are equal.
fn ground_truth(
    dir: &Path,
    frames: &[(ListedImage, ListedImage)],
    warnings: &mut Warnings,
) -> Option<Vec<(Stamp, Pose3)>> {
    let path = dir.join("groundtruth.txt");
    if !path.exists() {
        return None;
    }
    let mut file = read_optional_trajectory(&path);
    if file.is_indexed && file.poses.len() == frames.len() {
        file.poses.iter_mut().zip(frames).for_each(|((stamp, _), (color, _))| *stamp = color.stamp);
        file.warnings = Warnings::default();
    }
    warnings.extend(file.warnings);
    (!file.poses.is_empty()).then_some(file.poses)
}

/// The odometry; `None` without its file.
fn odometry(dir: &Path, warnings: &mut Warnings) -> Result<Option<Vec<(Stamp, Pose2)>>, IoError> {
    let path = dir.join("odometry.txt");
    // A link to nothing is an error of its reader.
    if path.symlink_metadata().is_err() {
        return Ok(None);
    }
    let (poses, mended) = read_optional_odometry(&path)?;
    warnings.extend(mended);
    Ok(Some(poses))
}

//! Reader of an RGB-D sequence in the TUM format.

use super::association::pair_nearest;
use super::list::{ListedImage, parse_list};
use super::{read_odometry, read_trajectory};
use crate::codec::{decode_color, decode_raw_depth};
use crate::files::{read_bytes, read_text};
use crate::{FrameError, IoError};
use std::path::{Path, PathBuf};
use trundle_core::{DepthImage, Invalid, Pose2, Pose3, RgbdImage, Stamp, require_finite, require_positive};

/// A recorded RGB-D sequence in TUM's form, its images still on disk.
///
/// The folder holds `rgb.txt` and `depth.txt` (lines of `timestamp filename`), the images they name (PNG or JPEG
/// colour, 16-bit PNG depth registered to it), and may hold `groundtruth.txt` (a TUM trajectory) and `odometry.txt`
/// (lines of `timestamp x y theta`).
#[derive(Debug, Clone)]
pub struct TumSequence {
    dir: PathBuf,
    depth_scale: f64,
    size: Option<(usize, usize)>,
    frames: Vec<(ListedImage, ListedImage)>,
    unpaired: usize,
    ground_truth: Option<Vec<(Stamp, Pose3)>>,
    odometry: Option<Vec<(Stamp, Pose2)>>,
}

impl TumSequence {
    /// How far apart in time a colour and a depth image of one frame may be, s: 0.02, as in TUM's tools.
    pub const MAX_DIFFERENCE: f64 = 0.02;

    /// Opens a folder: reads its lists and pairs each colour image with the depth image nearest in time, at most
    /// `max_difference` s apart. `depth_scale` is what a depth of 1 m is in the depth images (5000 for TUM).
    ///
    /// # Errors
    /// When the folder or a list is missing, a line is wrong, stamps do not rise, or no images can be paired.
    pub fn open(dir: &Path, depth_scale: f64, max_difference: f64) -> Result<Self, IoError> {
        let checked = require_positive("depth_scale", depth_scale, "units a metre")
            .and_then(|_| require_finite("max_difference", max_difference, "s"));
        checked.map_err(IoError::field(dir))?;
        check_folder(dir)?;
        let (color, depth) = (list(dir, "rgb.txt")?, list(dir, "depth.txt")?);
        let stamps = |list: &[ListedImage]| list.iter().map(|image| image.stamp).collect::<Vec<_>>();
        let pairs = pair_nearest(&stamps(&color), &stamps(&depth), max_difference);
        if pairs.is_empty() {
            return Err(IoError::malformed(dir, no_pair(&color, &depth, max_difference)));
        }
        Ok(Self {
            dir: dir.to_owned(),
            depth_scale,
            size: None,
            unpaired: color.len() - pairs.len(),
            frames: pairs.into_iter().map(|(i, j)| (color[i].clone(), depth[j].clone())).collect(),
            ground_truth: optional(&dir.join("groundtruth.txt"), read_trajectory)?,
            odometry: optional(&dir.join("odometry.txt"), read_odometry)?,
        })
    }

    /// Accepts from now on only images of `width` x `height` px, the camera's.
    pub fn with_size(mut self, width: usize, height: usize) -> Self {
        self.size = Some((width, height));
        self
    }

    /// The number of frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether there is no frame; never so.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// How many colour images have no depth image near enough and are left out.
    pub fn unpaired(&self) -> usize {
        self.unpaired
    }

    /// The stamp of frame `i`, that of its colour image. Panics beyond the last.
    pub fn stamp(&self, i: usize) -> Stamp {
        self.frames[i].0.stamp
    }

    /// `world_from_camera` by motion capture, where the folder has it.
    pub fn ground_truth(&self) -> Option<&[(Stamp, Pose3)]> {
        self.ground_truth.as_deref()
    }

    /// `odom_from_base`, where the folder has it.
    pub fn odometry(&self) -> Option<&[(Stamp, Pose2)]> {
        self.odometry.as_deref()
    }

    /// Reads and decodes frame `i`; depth becomes metres. Panics beyond the last.
    ///
    /// # Errors
    /// When one of its files is missing, truncated, of a wrong kind or size: the caller may go on with the next.
    pub fn load(&self, i: usize) -> Result<RgbdImage, FrameError> {
        let (color, depth) = &self.frames[i];
        self.image(color, depth).map_err(|source| FrameError { index: i, stamp: color.stamp, source })
    }

    /// All frames in order, broken ones as errors.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = Result<RgbdImage, FrameError>> + '_ {
        (0..self.len()).map(|i| self.load(i))
    }

    fn image(&self, color: &ListedImage, depth: &ListedImage) -> Result<RgbdImage, IoError> {
        let (color_path, depth_path) = (self.dir.join(&color.file), self.dir.join(&depth.file));
        let pixels = decode_color(&read_bytes(&color_path)?).map_err(IoError::image(&color_path))?;
        self.check_size("colour image size", (pixels.width(), pixels.height()))
            .map_err(IoError::field(&color_path))?;
        let raw = decode_raw_depth(&read_bytes(&depth_path)?).map_err(IoError::image(&depth_path))?;
        let metres = raw.data().iter().map(|&value| (f64::from(value) / self.depth_scale) as f32).collect();
        DepthImage::new(raw.width(), raw.height(), metres)
            .and_then(|metres| RgbdImage::new(color.stamp, pixels, metres))
            .map_err(IoError::field(&depth_path))
    }

    fn check_size(&self, name: &str, found: (usize, usize)) -> Result<(), Invalid> {
        match self.size {
            Some(size) if size != found => {
                let expected = format!("{} x {} as the camera", size.0, size.1);
                Err(Invalid::new(name, format!("{} x {}", found.0, found.1), "px", expected))
            }
            _ => Ok(()),
        }
    }
}

fn check_folder(dir: &Path) -> Result<(), IoError> {
    let mut entries = std::fs::read_dir(dir).map_err(IoError::system(dir, "read"))?;
    if entries.next().is_none() {
        return Err(IoError::malformed(dir, "the folder is empty, expected rgb.txt and depth.txt"));
    }
    for name in ["rgb.txt", "depth.txt"] {
        if !dir.join(name).exists() {
            let problem = format!("{name} is missing, expected rgb.txt and depth.txt in a TUM RGB-D folder");
            return Err(IoError::malformed(dir, problem));
        }
    }
    Ok(())
}

fn list(dir: &Path, name: &str) -> Result<Vec<ListedImage>, IoError> {
    let path = dir.join(name);
    parse_list(&path, &read_text(&path)?)
}

fn optional<T>(path: &Path, read: impl Fn(&Path) -> Result<T, IoError>) -> Result<Option<T>, IoError> {
    if path.exists() { read(path).map(Some) } else { Ok(None) }
}

fn no_pair(color: &[ListedImage], depth: &[ListedImage], max_difference: f64) -> String {
    let span = |list: &[ListedImage]| match list {
        [first, .., last] => format!("{} s to {} s", first.stamp, last.stamp),
        [only] => format!("{} s", only.stamp),
        [] => "none".to_owned(),
    };
    format!(
        "no colour image of rgb.txt ({}) is within {max_difference} s of a depth image of depth.txt ({})",
        span(color),
        span(depth)
    )
}

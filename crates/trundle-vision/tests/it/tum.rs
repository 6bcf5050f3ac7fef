//! Real images of the TUM data set.

use std::path::{Path, PathBuf};
use trundle_core::{ColorImage, DepthImage, Distortion, GrayImage, PinholeCamera, Pose3, gray_from_color};

/// A TUM RGB-D folder.
pub struct Recording {
    folder: PathBuf,
    /// Time and file of the colour, time and file of the depth image.
    frames: Vec<(f64, String, String)>,
    truth: Vec<(f64, Pose3)>,
}

impl Recording {
    /// freiburg1_rpy, or a word why not.
    pub fn open() -> Option<Self> {
        let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/tum_fr1_rpy_400"));
        if !folder.exists() {
            eprintln!("skipped: no {}", folder.display());
            return None;
        }
        let frames = rows(&folder.join("associations.txt"))
            .map(|row| (row[0].parse().unwrap(), row[1].clone(), row[3].clone()))
            .collect();
        let truth = rows(&folder.join("groundtruth.txt"))
            .map(|row| {
                let v: Vec<f64> = row.iter().map(|word| word.parse().unwrap()).collect();
                (v[0], Pose3::from([v[1], v[2], v[3], v[4], v[5], v[6], v[7]]))
            })
            .collect();
        Some(Self { folder: folder.into(), frames, truth })
    }

    pub fn len(&self) -> usize {
        self.frames.len()
    }

    pub fn camera() -> PinholeCamera {
        let lens = Distortion { k1: 0.2624, k2: -0.9531, p1: -0.0054, p2: 0.0026, k3: 1.1633 };
        PinholeCamera::new((640, 480), (517.3, 516.5), (318.6, 255.3), lens).unwrap()
    }

    /// Grey and depth image (m) of frame `i`.
    pub fn frame(&self, i: usize) -> (GrayImage, DepthImage) {
        let (_, color, depth) = &self.frames[i];
        let color = image::open(self.folder.join(color)).unwrap().into_rgb8();
        let depth = image::open(self.folder.join(depth)).unwrap().into_luma16();
        let (width, height) = (color.width() as usize, color.height() as usize);
        let color = ColorImage::new(width, height, color.pixels().map(|p| p.0).collect()).unwrap();
        let metres = depth.as_raw().iter().map(|d| f32::from(*d) / 5000.0).collect();
        (gray_from_color(&color), DepthImage::new(width, height, metres).unwrap())
    }

    /// The true `b_from_a` between the cameras of two frames.
    pub fn motion(&self, a: usize, b: usize) -> Pose3 {
        self.world_from_camera(b).inverse() * self.world_from_camera(a)
    }

    fn world_from_camera(&self, i: usize) -> Pose3 {
        let time = self.frames[i].0;
        let after = self.truth.partition_point(|(t, _)| *t < time).clamp(1, self.truth.len() - 1);
        let ((t0, before), (t1, next)) = (self.truth[after - 1], self.truth[after]);
        before.interpolate(&next, (time - t0) / (t1 - t0))
    }
}

fn rows(file: &Path) -> impl Iterator<Item = Vec<String>> {
    let text = std::fs::read_to_string(file).unwrap();
    let words = |line: &str| line.split_whitespace().map(str::to_owned).collect();
    text.lines().filter(|line| !line.starts_with('#')).map(words).collect::<Vec<_>>().into_iter()
}

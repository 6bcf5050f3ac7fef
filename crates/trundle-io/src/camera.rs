//! Camera files and presets: intrinsics and the unit of the depth images.

use crate::IoError;
use crate::files::read_text;
use serde::{Deserialize, Serialize};
use std::path::Path;
use trundle_core::{Distortion, Invalid, PinholeCamera, require_positive};

/// What 1 m is in TUM's depth images.
pub const TUM_DEPTH_SCALE: f64 = 5000.0;

/// What 1 m is in the depth images of a Kinect V2, and of trundle's recordings: millimetres.
pub const KINECT_V2_DEPTH_SCALE: f64 = 1000.0;

const PRESETS: &str = "freiburg1, freiburg2, freiburg3, kinect_v2";

/// A camera and the unit of its depth images.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraModel {
    /// Intrinsics, lens and readout time.
    pub camera: PinholeCamera,
    /// What 1 m is in its depth images.
    pub depth_scale: f64,
}

/// Readout time of a Kinect v1's colour camera: 0.026 s. Without it, images of a turning camera are distorted. Source: \[Ringaby11\].
const KINECT_V1_READOUT_S: f64 = 0.026;

impl CameraModel {
    /// The camera of a preset (`freiburg1`, `freiburg2`, `freiburg3`, `kinect_v2`) or else of a TOML file.
    ///
    /// # Errors
    /// When `name` is neither, or as [`CameraModel::read`].
    pub fn named(name: &str) -> Result<Self, IoError> {
        if let Some(model) = Self::preset(name) {
            return Ok(model);
        }
        let path = Path::new(name);
        if !path.exists() {
            let problem = format!("neither a file nor a camera preset ({PRESETS})");
            return Err(IoError::malformed(path, problem));
        }
        Self::read(path)
    }

    /// The camera of a preset. The three of the TUM RGB-D benchmark are its calibration of the colour cameras, to
    /// which depth is registered (`vision.in.tum.de/data/datasets/rgbd-dataset/file_formats`).
    pub fn preset(name: &str) -> Option<Self> {
        let lens = |k1, k2, p1, p2, k3| Distortion { k1, k2, p1, p2, k3 };
        let tum = |focal, centre, distortion, readout| {
            let camera = PinholeCamera::new((640, 480), focal, centre, distortion)
                .and_then(|camera| camera.with_readout(readout))
                .expect("invariant: the preset is valid");
            Self { camera, depth_scale: TUM_DEPTH_SCALE }
        };
        Some(match name {
            "freiburg1" => {
                let lens = lens(0.2624, -0.9531, -0.0054, 0.0026, 1.1633);
                tum((517.3, 516.5), (318.6, 255.3), lens, KINECT_V1_READOUT_S)
            }
            "freiburg2" => {
                let lens = lens(0.2312, -0.7849, -0.0033, -0.0001, 0.9172);
                tum((520.9, 521.0), (325.1, 249.7), lens, KINECT_V1_READOUT_S)
            }
            // An Xtion, whose readout is not known to us.
            "freiburg3" => tum((535.4, 539.2), (320.1, 247.6), Distortion::default(), 0.0),
            "kinect_v2" => {
                let camera = PinholeCamera::kinect_v2();
                Self { camera, depth_scale: KINECT_V2_DEPTH_SCALE }
            }
            _ => return None,
        })
    }

    /// The camera of a TOML file: `width`, `height`, `fx`, `fy`, `cx`, `cy` (px) and `depth_scale` (units a metre),
    /// and, 0 where left out, the lens `k1`, `k2`, `p1`, `p2`, `k3` in the order of OpenCV, and `readout` (s).
    ///
    /// # Errors
    /// With the line and key, when the file is no TOML, a key is wrong or missing, or a value is not accepted.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        Self::parse(path, &read_text(path)?)
    }

    /// The text of [`CameraModel::read`]; every number reads back as the same f64.
    pub fn to_toml(&self) -> String {
        let camera = &self.camera;
        let Distortion { k1, k2, p1, p2, k3 } = camera.distortion();
        let (width, height) = (camera.width(), camera.height());
        let (fx, fy, cx, cy) = (camera.fx(), camera.fy(), camera.cx(), camera.cy());
        let (depth_scale, readout) = (self.depth_scale, camera.readout());
        let file = CameraFile { width, height, fx, fy, cx, cy, depth_scale, k1, k2, p1, p2, k3, readout };
        toml::to_string(&file).expect("invariant: a camera is plain data")
    }

    fn parse(path: &Path, text: &str) -> Result<Self, IoError> {
        let file: CameraFile = toml::from_str(text).map_err(|error| located(path, text, &error))?;
        file.model().map_err(|invalid| match line_of_key(text, &invalid.field) {
            Some(line) => IoError::line(path, line, invalid.to_string()),
            None => IoError::field(path)(invalid),
        })
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraFile {
    width: usize,
    height: usize,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    depth_scale: f64,
    #[serde(default)]
    k1: f64,
    #[serde(default)]
    k2: f64,
    #[serde(default)]
    p1: f64,
    #[serde(default)]
    p2: f64,
    #[serde(default)]
    k3: f64,
    #[serde(default)]
    readout: f64,
}

impl CameraFile {
    fn model(self) -> Result<CameraModel, Invalid> {
        let Self { width, height, fx, fy, cx, cy, depth_scale, k1, k2, p1, p2, k3, readout } = self;
        let lens = Distortion { k1, k2, p1, p2, k3 };
        let camera = PinholeCamera::new((width, height), (fx, fy), (cx, cy), lens)?;
        require_positive("depth_scale", depth_scale, "units a metre")?;
        Ok(CameraModel { camera: camera.with_readout(readout)?, depth_scale })
    }
}

/// The parser's complaint with its line and, where a value is at fault, its key.
fn located(path: &Path, text: &str, error: &toml::de::Error) -> IoError {
    let message = error.message().replace('\n', ", ");
    let Some(span) = error.span().filter(|_| !message.starts_with("missing field")) else {
        return IoError::malformed(path, message);
    };
    let before = text.get(..span.start).unwrap_or(text);
    let line = before.bytes().filter(|&byte| byte == b'\n').count() + 1;
    let content = text.lines().nth(line - 1).unwrap_or_default();
    let key = content.split_once('=').map_or("", |(key, _)| key.trim());
    let names_it = key.is_empty() || message.contains(&format!("`{key}`"));
    let problem = if names_it { message } else { format!("{}: {message}", crate::excerpt::excerpt(key)) };
    IoError::line(path, line, problem)
}

fn line_of_key(text: &str, key: &str) -> Option<usize> {
    let is_key = |line: &str| line.split_once('=').is_some_and(|(name, _)| name.trim() == key);
    text.lines().position(is_key).map(|i| i + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const GOOD: &str = "width = 640\nheight = 480\nfx = 517.3\nfy = 516.5\ncx = 318.6\ncy = 255.3\n\
                        depth_scale = 5000.0\nk1 = 0.2624\nk2 = -0.9531\np1 = -0.0054\np2 = 0.0026\nk3 = 1.1633\nreadout = 0.026\n";

    fn problem(text: &str) -> String {
        CameraModel::parse(Path::new("cam.toml"), text).unwrap_err().to_string()
    }

    #[test]
    fn a_file_says_what_a_preset_says() {
        let file = CameraModel::parse(Path::new("cam.toml"), GOOD).unwrap();
        assert_eq!(Some(file), CameraModel::preset("freiburg1"));
        for name in PRESETS.split(", ") {
            let model = CameraModel::named(name).unwrap();
            assert_eq!(CameraModel::parse(Path::new("cam.toml"), &model.to_toml()).unwrap(), model);
        }
        assert_eq!(CameraModel::named("kinect_v2").unwrap().camera.width(), 512);
    }

    #[test]
    fn errors_name_file_line_and_key() {
        let unknown = problem(&GOOD.replace("k3", "k9"));
        assert!(unknown.starts_with("cam.toml, line 12: unknown field `k9`, expected one of"), "{unknown}");
        assert_eq!(problem(&GOOD.replace("fy = 516.5\n", "")), "cam.toml: missing field `fy`");
        let text = problem(&GOOD.replace("516.5", "'wide'"));
        assert!(text.starts_with("cam.toml, line 4: fy: invalid type: string"), "{text}");
        assert_eq!(
            problem(&GOOD.replace("517.3", "-1")),
            "cam.toml, line 3: fx is -1 px, expected a finite number above 0"
        );
        assert_eq!(
            problem(&GOOD.replace("5000.0", "nan")),
            "cam.toml, line 7: depth_scale is NaN units a metre, expected a finite number above 0"
        );
        assert!(problem(&GOOD.replace("0.026", "2.6")).starts_with("cam.toml, line 13: readout is 2.6 s"));
        assert!(problem("width = = 3").starts_with("cam.toml, line 1: "));
        assert!(problem(&GOOD.replace("640", "-640")).starts_with("cam.toml, line 1: "));
        assert_eq!(
            CameraModel::named("freiburg9").unwrap_err().to_string(),
            "freiburg9: neither a file nor a camera preset (freiburg1, freiburg2, freiburg3, kinect_v2)"
        );
    }

    proptest! {
        #[test]
        fn any_text_is_no_panic(cut in 0..GOOD.len(), text in "[a-z0-9 =.'\"\\[\\]\n]{0,30}") {
            let _ = CameraModel::parse(Path::new("a"), &format!("{}{text}", &GOOD[..cut]));
        }
    }
}

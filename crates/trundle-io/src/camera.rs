//! Camera files and presets: intrinsics and the unit of the depth images.

mod depth_scale;
mod fields;
mod image_side;
mod kalibr_yaml;
mod matrix;
mod open3d;
mod ros_lens;
mod ros_message;
mod ros_yaml;
mod slam_yaml;
mod toml_file;

pub(crate) use depth_scale::checked_depth_scale;
pub use depth_scale::{KINECT_V2_DEPTH_SCALE, TUM_DEPTH_SCALE};
pub(crate) use ros_message::{InfoNumbers, camera_of_info};

use crate::files::read_text;
use crate::{Expected, FileKind, IoError};
use fields::CameraFields;
use std::path::Path;
use toml_file::CameraFile;
use trundle_core::{Distortion, PinholeCamera};

const PRESETS: &str = "freiburg1, freiburg2, freiburg3, kinect_v2";

/// A camera and the unit of its depth images.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraModel {
    /// Intrinsics, lens and readout time.
    pub camera: PinholeCamera,
    /// Depth units per metre in its depth images.
    pub depth_scale: f64,
}

/// Readout time of a Kinect v1's colour camera: 0.026 s. With a wrong value, images of a turning camera are distorted. Source:
/// \[Ringaby11\].
const KINECT_V1_READOUT_S: f64 = 0.026;

/// The preset of an Xtion, whose readout time is not known to us.
const UNKNOWN_READOUT_PRESET: &str = "freiburg3";

/// Which numbers the description of a camera holds; the others are assumed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GivenNumbers {
    pub depth_scale: bool,
    pub readout: bool,
}

impl CameraModel {
    /// The camera of a preset (`freiburg1`, `freiburg2`, `freiburg3`, `kinect_v2`) or else of a file.
    ///
    /// # Errors
    /// When `name` is neither, or as [`CameraModel::read`].
    pub fn named(name: &str) -> Result<Self, IoError> {
        Self::described(name).map(|(model, _)| model)
    }

    /// The camera of a preset. The three TUM RGB-D presets are the benchmark's calibration of the colour cameras, to which depth is
    /// registered (`vision.in.tum.de/data/datasets/rgbd-dataset/file_formats`).
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
            UNKNOWN_READOUT_PRESET => tum((535.4, 539.2), (320.1, 247.6), Distortion::default(), 0.0),
            "kinect_v2" => {
                let camera = PinholeCamera::kinect_v2();
                Self { camera, depth_scale: KINECT_V2_DEPTH_SCALE }
            }
            _ => return None,
        })
    }

    /// The camera of a file: trundle's TOML, the YAML of ORB-SLAM2 and 3, of stella_vslam, of Kalibr, of
    /// EuRoC or of ROS's camera_info, or Open3D's JSON. The content determines the format.
    ///
    /// The TOML has `width`, `height`, `fx`, `fy`, `cx`, `cy` (px) and `depth_scale` (units per metre). The lens `k1`, `k2`, `p1`, `p2`,
    /// `k3` in OpenCV's order default to 0, and `readout` (s) to an unknown time, taken as 0. A file without a depth scale means millimetres, as in ROS.
    ///
    /// # Errors
    /// With the line and key, when the file has no known format, a key is wrong or missing, or a value is invalid.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        Self::of_fields(path, &Self::fields(path)?)
    }

    /// The camera of a preset or a file, and which of its numbers the description holds; the file is read once.
    pub(crate) fn described(name: &str) -> Result<(Self, GivenNumbers), IoError> {
        if let Some(model) = Self::preset(name) {
            return Ok((model, GivenNumbers { depth_scale: true, readout: name != UNKNOWN_READOUT_PRESET }));
        }
        let path = existing(name)?;
        let fields = Self::fields(path)?;
        let held =
            GivenNumbers { depth_scale: fields.depth_scale.is_some(), readout: fields.readout.is_some() };
        Ok((Self::of_fields(path, &fields)?, held))
    }

    /// The numbers of a file.
    fn fields(path: &Path) -> Result<CameraFields, IoError> {
        let kind = Expected::Camera.check(path)?;
        parse(path, kind, &read_text(path)?)
    }

    fn of_fields(path: &Path, fields: &CameraFields) -> Result<Self, IoError> {
        let camera = fields.camera().map_err(IoError::field(path))?;
        Ok(Self { camera, depth_scale: fields.depth_scale.unwrap_or(KINECT_V2_DEPTH_SCALE) })
    }

    /// The text of a TOML file for [`CameraModel::read`]; every number reads back as the same f64.
    pub fn to_toml(&self) -> String {
        let file = CameraFile::of(&self.camera, self.depth_scale);
        toml::to_string(&file).expect("invariant: a camera is plain data")
    }
}

/// The path of a camera file.
fn existing(name: &str) -> Result<&Path, IoError> {
    let path = Path::new(name);
    let problem = || IoError::malformed(path, format!("neither a file nor a camera preset ({PRESETS})"));
    path.exists().then_some(path).ok_or_else(problem)
}

/// The numbers of a file of this kind.
fn parse(path: &Path, kind: FileKind, text: &str) -> Result<CameraFields, IoError> {
    match kind {
        FileKind::OrbSlamYaml | FileKind::StellaVslamYaml => slam_yaml::parse(path, text),
        FileKind::RosCameraYaml | FileKind::Yaml => ros_yaml::parse(path, text),
        FileKind::KalibrCameraYaml => kalibr_yaml::parse(path, text),
        FileKind::Open3dCamera | FileKind::Json => open3d::parse(path, text),
        _ => toml_file::parse(path, text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const GOOD: &str = "width = 640\nheight = 480\nfx = 517.3\nfy = 516.5\ncx = 318.6\ncy = 255.3\n\
                        depth_scale = 5000.0\nk1 = 0.2624\nk2 = -0.9531\np1 = -0.0054\np2 = 0.0026\nk3 = 1.1633\nreadout = 0.026\n";

    fn problem(text: &str) -> String {
        toml_file::parse(Path::new("cam.toml"), text).unwrap_err().to_string()
    }

    #[test]
    fn a_file_holds_the_numbers_of_its_preset() {
        let parse = |text: &str| {
            let fields = toml_file::parse(Path::new("cam.toml"), text).unwrap();
            CameraModel::of_fields(Path::new("cam.toml"), &fields).unwrap()
        };
        let file = parse(GOOD);
        assert_eq!(Some(file), CameraModel::preset("freiburg1"));
        for name in PRESETS.split(", ") {
            let model = CameraModel::named(name).unwrap();
            assert_eq!(parse(&model.to_toml()), model);
        }
        assert_eq!(CameraModel::named("kinect_v2").unwrap().camera.width(), 512);
    }

    #[test]
    fn errors_name_file_line_and_key() {
        let unknown = problem(&GOOD.replace("k3", "k9"));
        assert!(unknown.starts_with("cam.toml, line 12: unknown key k9, expected one of"), "{unknown}");
        assert_eq!(problem(&GOOD.replace("fy = 516.5\n", "")), "cam.toml, line 1: the key fy is missing");
        let text = problem(&GOOD.replace("516.5", "'wide'"));
        assert!(text.starts_with("cam.toml, line 4: fy is \"wide\", expected a number"), "{text}");
        assert_eq!(
            problem(&GOOD.replace("517.3", "-1")),
            "cam.toml, line 3: fx is -1 px, expected a finite number above 0"
        );
        assert_eq!(
            problem(&GOOD.replace("5000.0", "nan")),
            "cam.toml, line 7: depth_scale is NaN units per metre, expected a finite number above 0"
        );
        assert!(problem(&GOOD.replace("0.026", "2.6")).starts_with("cam.toml, line 13: readout is 2.6 s"));
        let beside = problem(&GOOD.replace("318.6", "3186"));
        assert!(beside.contains("line 5: cx is 3186 px, expected 0 to 639 px, inside the image"), "{beside}");
        assert!(problem("width = = 3").starts_with("cam.toml, line 1: "));
        assert!(problem(&GOOD.replace("640", "-640")).starts_with("cam.toml, line 1: "));
        assert_eq!(
            CameraModel::named("freiburg9").unwrap_err().to_string(),
            "freiburg9: neither a file nor a camera preset (freiburg1, freiburg2, freiburg3, kinect_v2)"
        );
    }

    proptest! {
        #[test]
        fn any_text_does_not_panic(cut in 0..GOOD.len(), text in "[a-z0-9 =.'\"\\[\\]\n]{0,30}") {
            let _ = toml_file::parse(Path::new("a"), &format!("{}{text}", &GOOD[..cut]));
        }
    }
}

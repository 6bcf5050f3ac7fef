//! The camera of a sequence: the requested one, the folder's own, or an assumed one.

use crate::camera::CameraModel;
use crate::{Expected, FileKind, IoError, Warnings};
use std::path::{Path, PathBuf};

/// The preset for an unknown camera.
const ASSUMED_PRESET: &str = "freiburg1";

/// The camera of a sequence and its source.
#[derive(Debug, Clone, PartialEq)]
pub struct SequenceCamera {
    /// The camera.
    pub model: CameraModel,
    /// The preset or the file.
    pub name: String,
    /// Whether the readout time is known; else it is 0 in the model.
    pub is_readout_known: bool,
    /// Whether the file or preset has the depth scale; else it is 1000 in the model.
    pub is_depth_scale_known: bool,
    /// Whether the camera is a guess: neither options nor files give one.
    pub is_assumed: bool,
    /// Warnings about the choice.
    pub warnings: Warnings,
}

impl SequenceCamera {
    /// The requested preset or file, else `camera.toml` of the folder, else another camera file in it, recognised by its
    /// content, else freiburg1 with a warning.
    ///
    /// # Errors
    /// When the requested camera, or the folder's file, is invalid.
    pub fn choose(asked: Option<&str>, dir: &Path) -> Result<Self, IoError> {
        if let Some(name) = asked {
            return Self::named(name);
        }
        let own = camera_files(dir);
        let Some(file) = own.first() else { return Self::assumed(dir) };
        let mut camera = Self::named(&file.display().to_string())?;
        if own.len() > 1 {
            let problem = format!("{} camera files in the folder, the first is taken", own.len());
            camera.warnings.add(&problem, &file.display().to_string());
        }
        Ok(camera)
    }

    fn named(name: &str) -> Result<Self, IoError> {
        let (model, held) = CameraModel::described(name)?;
        Ok(Self {
            model,
            name: name.to_owned(),
            is_readout_known: held.readout,
            is_depth_scale_known: held.depth_scale,
            is_assumed: false,
            warnings: Warnings::default(),
        })
    }

    fn assumed(dir: &Path) -> Result<Self, IoError> {
        Expected::Sequence.check(dir)?;
        let model = CameraModel::preset(ASSUMED_PRESET).expect("invariant: a preset's name");
        let mut warnings = Warnings::default();
        let (width, height) = (model.camera.width(), model.camera.height());
        let problem = format!(
            "no camera file in the folder, expected camera.toml: the camera {ASSUMED_PRESET} is assumed ({width} x {height} px, fx {:.1} px, \
             depth_scale {} units per metre); write camera.toml or give --camera PRESET|FILE",
            model.camera.fx(),
            model.depth_scale
        );
        warnings.add(&problem, &dir.display().to_string());
        let name = ASSUMED_PRESET.to_owned();
        let (is_readout_known, is_depth_scale_known) = (true, true);
        Ok(Self { model, name, is_readout_known, is_depth_scale_known, is_assumed: true, warnings })
    }
}

/// The camera files of a folder: only `camera.toml` if it exists, else all by their content, sorted by name.
fn camera_files(dir: &Path) -> Vec<PathBuf> {
    let own = dir.join("camera.toml");
    if own.exists() {
        return vec![own];
    }
    let entries = std::fs::read_dir(dir).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_camera = |path: &PathBuf| {
        let cameras = [
            FileKind::CameraToml,
            FileKind::OrbSlamYaml,
            FileKind::StellaVslamYaml,
            FileKind::RosCameraYaml,
            FileKind::KalibrCameraYaml,
            FileKind::Open3dCamera,
        ];
        path.is_file() && Expected::Camera.check(path).is_ok_and(|kind| cameras.contains(&kind))
    };
    let mut files: Vec<PathBuf> = entries.filter(is_camera).collect();
    files.sort();
    files
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const ORB_SLAM: &str = "%YAML:1.0\n---\nCamera.type: \"PinHole\"\nCamera.fx: 525.0\nCamera.fy: 526.0\nCamera.cx: 319.5\n\
                            Camera.cy: 239.5\nCamera.k1: 0.1\nCamera.width: 640\nCamera.height: 480\nDepthMapFactor: 5000.0\n";

    fn camera(content: &str) -> Result<CameraModel, String> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("camera.file");
        fs::write(&path, content).unwrap();
        CameraModel::read(&path)
            .map_err(|error| error.to_string().replace(&path.display().to_string(), "FILE"))
    }

    #[test]
    fn one_camera_is_the_same_in_every_form() {
        let expected = camera(ORB_SLAM).unwrap();
        assert_eq!(
            (expected.camera.fx(), expected.camera.distortion().k1, expected.depth_scale),
            (525.0, 0.1, 5000.0)
        );
        let orb_slam3 = ORB_SLAM.replace("Camera.fx", "Camera1.fx").replace("Camera.fy", "Camera1.fy");
        let orb_slam3 = orb_slam3.replace("Camera.c", "Camera1.c").replace("Camera.k1", "Camera1.k1");
        let orb_slam3 = orb_slam3.replace("DepthMapFactor", "RGBD.DepthMapFactor");
        let stella = "Camera:\n  name: a\n  setup: \"RGBD\"\n  model: \"perspective\"\n  fx: 525\n  fy: 526\n  cx: 319.5\n  cy: 239.5\n\
                      \x20 k1: 0.1\n  cols: 640\n  rows: 480\n  depthmap_factor: 5000\n";
        let toml = "width = 640\nheight = 480\nfx = 525.0\nfy = 526.0\ncx = 319.5\ncy = 239.5\nk1 = 0.1\ndepth_scale = 5000.0\n";
        let scale_of_preprocessing = stella.replace("  depthmap_factor", "Preprocessing:\n  depthmap_factor");
        for form in [&orb_slam3, stella, &scale_of_preprocessing, toml] {
            assert_eq!(camera(form).as_ref(), Ok(&expected), "{form}");
        }
        let ros = "image_width: 640\nimage_height: 480\ncamera_name: a\ncamera_matrix:\n  rows: 3\n  cols: 3\n\
                   \x20 data: [525, 0, 319.5, 0, 526, 239.5, 0, 0, 1]\ndistortion_model: plumb_bob\n\
                   distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.1, 0, 0, 0, 0]\n";
        let echo = "header:\n  frame_id: a\nheight: 480\nwidth: 640\ndistortion_model: plumb_bob\nd:\n- 0.1\n- 0.0\n\
                    k: [525, 0, 319.5, 0, 526, 239.5, 0, 0, 1]\n---\nheight: 1\n";
        for form in [ros, echo] {
            assert_eq!(camera(form).unwrap().camera, expected.camera, "{form}");
        }
        let open3d = "{\"width\": 640, \"height\": 480, \"intrinsic_matrix\": [525, 0, 0, 0, 526, 0, 319.5, 239.5, 1]}";
        assert_eq!(camera(open3d).unwrap().camera.cy(), 239.5);
        assert_eq!(camera(open3d).unwrap().depth_scale, 1000.0);
    }

    #[test]
    fn missing_and_wrong_fields_of_a_file_are_named_with_their_line() {
        assert_eq!(
            camera(&ORB_SLAM.replace("Camera.fy: 526.0\n", "")).unwrap_err(),
            "FILE: Camera.fy is missing, expected px"
        );
        let problem = camera(&ORB_SLAM.replace("525.0", "-1")).unwrap_err();
        assert!(problem.starts_with("FILE, line 4: Camera.fx is -1 px"), "{problem}");
        let problem = camera(&ORB_SLAM.replace("5000.0", "0.001")).unwrap_err();
        assert!(
            problem.starts_with("FILE, line 11: DepthMapFactor is 0.001, expected units per metre"),
            "{problem}"
        );
        let problem = camera(&ORB_SLAM.replace("PinHole", "KannalaBrandt8")).unwrap_err();
        assert!(
            problem.contains("line 3: Camera.type is 'KannalaBrandt8', expected a pinhole camera"),
            "{problem}"
        );
        let problem = camera(&ORB_SLAM.replace("525.0", "0.82")).unwrap_err();
        assert!(
            problem.starts_with("FILE, line 4: Camera.fx is 0.82 px, expected 58 to 12800 px"),
            "{problem}"
        );
        assert!(camera("{\"intrinsic_matrix\": [1]}").unwrap_err().contains("expected width, height"));
        assert!(camera("image: m.pgm\nresolution: 1\n").unwrap_err().contains("this is a map's YAML file"));
    }

    #[test]
    fn a_folder_brings_its_camera_and_an_assumed_one_is_said() {
        let dir = tempfile::tempdir().unwrap();
        let message =
            |camera: &SequenceCamera| camera.warnings.iter().map(ToString::to_string).collect::<String>();
        fs::write(dir.path().join("rgb.txt"), "1 a.png\n").unwrap();
        let assumed = SequenceCamera::choose(None, dir.path()).unwrap();
        assert!(
            assumed.is_assumed && message(&assumed).contains("freiburg1 is assumed"),
            "{}",
            message(&assumed)
        );
        fs::write(dir.path().join("settings.yaml"), ORB_SLAM).unwrap();
        let own = SequenceCamera::choose(None, dir.path()).unwrap();
        assert!(!own.is_assumed && own.name.ends_with("settings.yaml") && own.warnings.is_empty());
        assert_eq!(own.model.camera.fx(), 525.0);
        fs::write(dir.path().join("camera.toml"), CameraModel::preset("kinect_v2").unwrap().to_toml())
            .unwrap();
        assert!(SequenceCamera::choose(None, dir.path()).unwrap().name.ends_with("camera.toml"));
        assert_eq!(SequenceCamera::choose(Some("freiburg3"), dir.path()).unwrap().name, "freiburg3");
    }
}

//! Settings files with which ORB-SLAM2 and ORB-SLAM3 run on a TUM folder.

use crate::CameraModel;
use trundle_core::Distortion;

/// The baseline at which ORB-SLAM models a depth camera as a stereo camera, m. Source: ORB-SLAM's TUM settings, 40 px / 525 px.
const STEREO_BASELINE_M: f64 = 40.0 / 525.0;

/// Depths above this many baselines are "far" to ORB-SLAM. Source: ORB-SLAM's TUM settings.
const FAR_BASELINES: f64 = 40.0;

/// Required keys of extractor and viewer, with the values of ORB-SLAM's TUM settings.
const REST: &str = r#"
ORBextractor.nFeatures: 1000
ORBextractor.scaleFactor: 1.2
ORBextractor.nLevels: 8
ORBextractor.iniThFAST: 20
ORBextractor.minThFAST: 7

Viewer.KeyFrameSize: 0.05
Viewer.KeyFrameLineWidth: 1.0
Viewer.GraphLineWidth: 0.9
Viewer.PointSize: 2.0
Viewer.CameraSize: 0.08
Viewer.CameraLineWidth: 3.0
Viewer.ViewpointX: 0.0
Viewer.ViewpointY: -0.7
Viewer.ViewpointZ: -1.8
Viewer.ViewpointF: 500.0
"#;

/// The settings file for ORB-SLAM2 and ORB-SLAM3 on a folder of this camera at `rate_hz`, in OpenCV's YAML with the keys of both programs.
/// Real numbers have a decimal point, which both programs require.
pub(super) fn orb_slam_yaml(model: &CameraModel, rate_hz: f64) -> String {
    let mut text = String::from("%YAML:1.0\n---\nFile.version: \"1.0\"\n\nCamera.type: \"PinHole\"\n");
    let mut set = |key: &str, value: String| text.push_str(&format!("{key}: {value}\n"));
    for (name, value) in intrinsics(model) {
        set(&format!("Camera.{name}"), format!("{value:?}"));
        set(&format!("Camera1.{name}"), format!("{value:?}"));
    }
    set("Camera.width", model.camera.width().to_string());
    set("Camera.height", model.camera.height().to_string());
    set("Camera.fps", format!("{:.0}", rate_hz.max(1.0)));
    set("Camera.RGB", "1".to_owned());
    set("Camera.bf", format!("{:?}", STEREO_BASELINE_M * model.camera.fx()));
    set("Stereo.b", format!("{STEREO_BASELINE_M:?}"));
    set("ThDepth", format!("{FAR_BASELINES:?}"));
    set("Stereo.ThDepth", format!("{FAR_BASELINES:?}"));
    set("DepthMapFactor", format!("{:?}", model.depth_scale));
    set("RGBD.DepthMapFactor", format!("{:?}", model.depth_scale));
    text + REST
}

fn intrinsics(model: &CameraModel) -> impl Iterator<Item = (&'static str, f64)> {
    let camera = &model.camera;
    let Distortion { k1, k2, p1, p2, k3 } = camera.distortion();
    let (fx, fy, cx, cy) = (camera.fx(), camera.fy(), camera.cx(), camera.cy());
    let lens = [("k1", k1), ("k2", k2), ("p1", p1), ("p2", p2), ("k3", k3)];
    [("fx", fx), ("fy", fy), ("cx", cx), ("cy", cy)].into_iter().chain(lens)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_programs_find_their_keys() {
        let model = CameraModel::preset("freiburg1").unwrap();
        let text = orb_slam_yaml(&model, 30.0);
        assert!(text.starts_with("%YAML:1.0\n---\n"));
        for line in [
            "Camera.fx: 517.3",
            "Camera1.fx: 517.3",
            "Camera.k3: 1.1633",
            "Camera.width: 640",
            "Camera.fps: 30",
            "Camera.RGB: 1",
            "DepthMapFactor: 5000.0",
            "RGBD.DepthMapFactor: 5000.0",
            "ThDepth: 40.0",
            "ORBextractor.nFeatures: 1000",
        ] {
            assert!(text.lines().any(|found| found == line), "{line} is missing in\n{text}");
        }
        let ideal = CameraModel::preset("kinect_v2").unwrap();
        assert!(orb_slam_yaml(&ideal, 15.0).contains("Camera.k1: 0.0\n"));
    }
}

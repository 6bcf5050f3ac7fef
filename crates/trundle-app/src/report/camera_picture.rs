//! Landmarks and camera images for reports.

use trundle_core::{RgbdImage, Vector3};
use trundle_runtime::Robot;
use trundle_slam::SeenFeature;
use trundle_viz::{CameraView, FeatureMark};

/// The visual landmarks, map frame, m.
pub fn landmarks_in_map(robot: &Robot) -> Vec<Vector3> {
    let Some(map_from_visual) = robot.map_from_visual() else { return Vec::new() };
    let Some(slam) = robot.slam() else { return Vec::new() };
    slam.landmarks().map(|landmark| map_from_visual.transform(landmark)).collect()
}

/// An image with its features.
pub fn camera_view(image: &RgbdImage, features: &[SeenFeature]) -> CameraView {
    CameraView { color: image.color().clone(), features: features.iter().map(mark).collect() }
}

/// Side of a feature's patch on the full-size level \[px\]. Source: \[Rublee11\].
const PATCH_PX: f64 = 31.0;
/// Ratio of the patch's sides on neighbouring levels of the pyramid. Source: \[Rublee11\].
const OCTAVE_SCALE: f64 = 1.2;

fn mark(feature: &SeenFeature) -> FeatureMark {
    let keypoint = feature.keypoint;
    FeatureMark {
        x: f64::from(keypoint.x),
        y: f64::from(keypoint.y),
        size: PATCH_PX * OCTAVE_SCALE.powi(i32::from(keypoint.octave)),
        angle: f64::from(keypoint.angle),
        tracked: feature.tracked,
    }
}

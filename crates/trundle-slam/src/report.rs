//! Report of one frame.

use crate::frame::reduction::Reduction;
use crate::ids::{KeyframeId, MapId};
use crate::loop_closing::loop_closure::LoopClosure;
use crate::tracking::tracking_status::Tracking;
use nalgebra::Matrix6;
use serde::{Deserialize, Serialize};
use trundle_core::{Pose3, Stamp, Vector2};
use trundle_vision::Keypoint;

/// Mapping, or localization in fixed maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// Maps grow and are refined.
    #[default]
    Mapping,
    /// Maps do not change.
    Localisation,
}

/// A merge of two maps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapMerge {
    /// The newer map, which is merged into the older one.
    pub from: MapId,
    /// The older map, whose frame is kept.
    pub into: MapId,
    /// The common keyframe, by its id in the older map.
    pub keyframe: KeyframeId,
    /// Number of points of the other map found in the keyframe.
    pub points: usize,
    /// Correction of the camera's pose: `new_from_old`.
    pub correction: Pose3,
}

/// Report of one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackReport {
    /// Stamp of the image.
    pub stamp: Stamp,
    /// Result of the tracking of the frame.
    pub tracking: Tracking,
    /// The map of `visual_from_camera`.
    pub map: MapId,
    /// The camera's pose in the visual frame of that map, which is the first camera's unless another was given.
    pub visual_from_camera: Pose3,
    /// Covariance of that pose as a right perturbation (m, m, m, rad, rad, rad), relative to the first keyframe. It contains the error of
    /// the pose in the map and the drift of the map. It grows while frames are not located.
    pub covariance: Matrix6<f64>,
    /// Features found in the image, without those on depth edges.
    pub features: usize,
    /// Number of features matched with landmarks, before alignment.
    pub matches: usize,
    /// Number of matches that agree with the pose at 95 %.
    pub inliers: usize,
    /// Whether the pose comes from a similar keyframe, without the motion prediction.
    pub relocalised: bool,
    /// Whether the frame became a keyframe.
    pub new_keyframe: bool,
    /// The loop closed since the last frame, with its correction of the camera's pose, which is not a motion.
    pub closed_loop: Option<LoopClosure>,
    /// The merge by this frame, with its correction of the camera's pose.
    pub merged: Option<MapMerge>,
    /// Correction of the camera's pose by bundle adjustment since the last frame: `new_from_old`, not a motion.
    pub refined: Option<Pose3>,
    /// Number of keyframes in the map after this frame.
    pub keyframes: usize,
    /// Number of landmarks in the map after this frame.
    pub landmarks: usize,
}

/// A past frame by the present maps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FramePose {
    /// Stamp of the image.
    pub stamp: Stamp,
    /// The map of the pose.
    pub map: MapId,
    /// The camera's pose in the frame of that map; `None` if the image did not locate the camera.
    pub visual_from_camera: Option<Pose3>,
}

/// A feature of the last frame, for pictures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenFeature {
    /// Position in the raw image, and size.
    pub keypoint: Keypoint,
    /// Whether the feature shows a landmark that agrees with the pose.
    pub tracked: bool,
}

impl SeenFeature {
    /// The feature at its position in the image before the reduction.
    pub(crate) fn enlarged(mut self, reduction: Reduction) -> Self {
        let keypoint = &mut self.keypoint;
        if reduction.factor() > 1 {
            let full = reduction.enlarged(Vector2::new(f64::from(keypoint.x), f64::from(keypoint.y)));
            (keypoint.x, keypoint.y) = (full.x as f32, full.y as f32);
        }
        self
    }
}

//! Report of one frame.

use crate::ids::{KeyframeId, MapId};
use crate::loop_closing::loop_closure::LoopClosure;
use crate::tracking::tracking_status::Tracking;
use nalgebra::Matrix6;
use serde::{Deserialize, Serialize};
use trundle_core::{Pose3, Stamp};
use trundle_vision::Keypoint;

/// Whether maps are made or only used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// Maps grow and get better.
    #[default]
    Mapping,
    /// Maps stay as they are, to the bit.
    Localisation,
}

/// Two maps that became one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapMerge {
    /// The newer map, which is merged into the older one.
    pub from: MapId,
    /// The older one, whose frame counts from now on.
    pub into: MapId,
    /// The keyframe that showed both, by its number in the older map.
    pub keyframe: KeyframeId,
    /// Points of the other map found in it.
    pub points: usize,
    /// How the camera's pose changed: `new_from_old`.
    pub correction: Pose3,
}

/// Report of one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackReport {
    /// Of the image.
    pub stamp: Stamp,
    /// How well it was located.
    pub tracking: Tracking,
    /// The map that the camera is in, or was last.
    pub map: MapId,
    /// The camera's pose in the visual frame of that map, which is the first camera's unless another was given.
    pub visual_from_camera: Pose3,
    /// Covariance of that pose as a right perturbation (m, m, m, rad, rad, rad), against the first keyframe: of the pose
    /// on the map, and of the map along the chain of keyframes that leads here. Grows while not located.
    pub covariance: Matrix6<f64>,
    /// Features found in the image, without those on depth edges.
    pub features: usize,
    /// Features matched with landmarks, before what is around them was compared.
    pub matches: usize,
    /// Of these, the ones that agree with the pose at 95 %.
    pub inliers: usize,
    /// Whether the pose was found without the motion prediction, from a similar keyframe.
    pub relocalised: bool,
    /// Whether the frame became a keyframe.
    pub new_keyframe: bool,
    /// The loop that was closed since the last frame, and how that moved the camera: a correction, not a motion.
    pub closed_loop: Option<LoopClosure>,
    /// The map recognised by it, and how that moved the camera.
    pub merged: Option<MapMerge>,
    /// How refining the map moved the camera since the last frame: `new_from_old`, a correction, not a motion.
    pub refined: Option<Pose3>,
    /// Keyframes in the map, after this frame.
    pub keyframes: usize,
    /// Landmarks in the map, after this frame.
    pub landmarks: usize,
}

/// A past frame by the present maps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FramePose {
    /// Of the image.
    pub stamp: Stamp,
    /// The map that the camera was in.
    pub map: MapId,
    /// The camera's pose in the frame of that map; `None` if the image did not locate the camera.
    pub visual_from_camera: Option<Pose3>,
}

/// A feature of the last frame, for pictures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenFeature {
    /// Where it is in the raw image, and how large.
    pub keypoint: Keypoint,
    /// Whether it is a landmark that agrees with the pose.
    pub tracked: bool,
}

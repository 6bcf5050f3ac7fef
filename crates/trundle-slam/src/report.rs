use crate::closing::LoopClosure;
use nalgebra::Matrix6;
use serde::{Deserialize, Serialize};
use trundle_core::{Pose3, Stamp};
use trundle_vision::Keypoint;

/// How well the last frame was located.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tracking {
    /// Located against the landmark map.
    Ok,
    /// Located, but by few landmarks: the covariance says how well.
    Weak,
    /// Not located: the pose is the last one moved by the given prior.
    DeadReckoning,
    /// Not located and no prior: the pose is held.
    Lost,
}

impl Tracking {
    /// Whether the pose comes from the image.
    pub fn is_located(self) -> bool {
        matches!(self, Self::Ok | Self::Weak)
    }
}

/// What became of one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackReport {
    /// Of the image.
    pub stamp: Stamp,
    /// How well it was located.
    pub tracking: Tracking,
    /// The camera's pose in the visual frame, which is the first camera's unless another was given.
    pub visual_from_camera: Pose3,
    /// Covariance of that pose as a right perturbation (m, m, m, rad, rad, rad), against the first keyframe: of the pose
    /// on the map, and of the map along the chain of keyframes that leads here. Grows while not located.
    pub covariance: Matrix6<f64>,
    /// Features found in the image.
    pub features: usize,
    /// Features matched with landmarks.
    pub matches: usize,
    /// Matches that agree with the pose at 95 %.
    pub inliers: usize,
    /// Whether the pose was found without the motion prediction, from a keyframe that looks alike.
    pub relocalised: bool,
    /// Whether the frame became a keyframe.
    pub new_keyframe: bool,
    /// The place seen again by it, and how that moved the camera.
    pub closed_loop: Option<LoopClosure>,
    /// Keyframes in the map, after this frame.
    pub keyframes: usize,
    /// Landmarks in the map, after this frame.
    pub landmarks: usize,
}

/// A feature of the last frame, for pictures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenFeature {
    /// Where it is in the raw image, and how large.
    pub keypoint: Keypoint,
    /// Whether it is a landmark that agrees with the pose.
    pub tracked: bool,
}

//! A frame that stays in the map.

use crate::frame::rgbd_frame::Frame;
use crate::ids::LandmarkId;
use crate::map::odometry_factor::OdometryFactor;
use crate::map::tree_node::TreeNode;
use nalgebra::Matrix6;
use trundle_core::Pose3;

/// A frame that stays in the map.
#[derive(Debug, Clone)]
pub(crate) struct Keyframe {
    pub frame: Frame,
    pub visual_from_camera: Pose3,
    /// Of that pose as a right perturbation, against the first keyframe.
    pub covariance: Matrix6<f64>,
    /// The part of the covariance that its points share, as of one rigid body: a frame located by these points inherits it.
    pub map_covariance: Matrix6<f64>,
    /// Which landmark each feature is of.
    pub landmarks: Vec<Option<LandmarkId>>,
    /// Where it stands in the spanning tree.
    pub(crate) tree: TreeNode,
    /// Odometry to it from the keyframe before, if it was measured.
    pub odometry: Option<OdometryFactor>,
}

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
    /// Covariance of the pose relative to the first keyframe, as a right perturbation.
    pub covariance: Matrix6<f64>,
    /// The part of the covariance that all points of the keyframe share, as of one rigid body. A frame located by these points inherits
    /// this part.
    pub map_covariance: Matrix6<f64>,
    /// The landmark of each feature.
    pub landmarks: Vec<Option<LandmarkId>>,
    /// Node of the spanning tree.
    pub(crate) tree: TreeNode,
    /// Odometry from the previous keyframe, if measured.
    pub odometry: Option<OdometryFactor>,
}

//! Keyframes, landmarks, and the graphs between them.

pub(crate) mod anchored_pose;
pub(crate) mod arena;
pub(crate) mod covisibility;
pub(crate) mod floor_plane;
pub(crate) mod keyframe;
pub(crate) mod keyframe_grid;
pub(crate) mod landmark;
pub(crate) mod landmark_map;
pub(crate) mod odometry_factor;
pub(crate) mod odometry_track;
pub(crate) mod reference_patch;
pub(crate) mod spanning_tree;
pub(crate) mod tree_node;

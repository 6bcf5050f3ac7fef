//! One RGB-D image: features, depths and their standard deviations.

pub(crate) mod aligned_feature;
pub(crate) mod depth;
pub(crate) mod depth_edges;
pub(crate) mod front_end;
pub(crate) mod observation_model;
pub(crate) mod reduction;
pub(crate) mod rgbd_frame;

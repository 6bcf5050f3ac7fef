//! Motion of the camera between images: priors, velocity and their uncertainty.

pub(crate) mod floor_axis;
pub(crate) mod motion_limits;
pub(crate) mod motion_model;
pub(crate) mod pose_belief;
pub(crate) mod uncertain_pose;

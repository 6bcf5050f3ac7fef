//! The motion between two RGB-D frames from paired points (METHODS A1): RANSAC over three-point motions, polished by
//! reprojection.

mod ransac;
mod refine;
mod residual;
mod rigid;

pub use ransac::{RansacConfig, RansacResult, estimate_rigid_motion};
pub use refine::{RefineConfig, refine_pose_by_reprojection};

//! The motion between two RGB-D frames from paired points (METHODS A1): RANSAC over three-point motions, polished by
//! reprojection.

mod ransac;
mod ransac_config;
mod refine;
mod residual;
mod rigid;

pub use ransac::{RansacResult, estimate_rigid_motion};
pub use ransac_config::RansacConfig;
pub use refine::{RefineConfig, refine_pose_by_reprojection};

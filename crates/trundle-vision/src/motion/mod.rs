//! Motion from paired features (docs/methods.md A1): RANSAC over three-point motions between two RGB-D frames. Without depth, RANSAC runs
//! over the poses that three points and their pixels allow. The result is refined by reprojection.

mod consensus;
mod p3p;
mod pnp;
mod ransac;
mod ransac_config;
mod refine;
mod residual;
mod rigid;

pub use pnp::estimate_pose_pnp;
pub use ransac::{RansacResult, estimate_rigid_motion};
pub use ransac_config::RansacConfig;
pub use refine::{RefineConfig, refine_pose_by_reprojection};

//! Solvers for trundle: robust least squares on SE(3) over what an RGB-D camera says of points.
//!
//! [`PoseProblem`] refines one camera pose against known points (tracking); [`BundleProblem`] refines several poses and
//! the points together by the Schur complement (local bundle adjustment, Triggs et al. 2000); [`PoseGraph`] spreads a
//! closed loop's correction over poses tied by relative measurements. The first two share the residual of
//! [`PointObservation`] (rectified pixel and inverse depth, each in its standard deviations), the Huber loss and the
//! perturbation: poses are `world_from_camera`, moved on the right, translation first, so that a covariance is that of
//! the camera in its own frame. Everything runs on one thread in a fixed order: the same input gives the same bits.

mod block;
mod block_cholesky;
mod bundle;
mod bundle_layout;
mod bundle_solver;
mod bundle_system;
mod huber;
mod leverage;
mod narrow_order;
mod observation;
mod pose;
mod pose_graph;
mod pose_prior;

pub use bundle::{BundleConfig, BundleObservation, BundlePose, BundleProblem, BundleSolution};
pub use bundle_solver::BundleSolver;
pub use huber::Huber;
pub use observation::{CHI2_95_2, CHI2_95_3, CHI2_95_6, InverseDepth, Linearized, PointObservation};
pub use pose::{CORRELATED_POINTS, PoseConfig, PoseProblem, PoseSolution};
pub use pose_graph::{PoseConstraint, PoseGraph, PoseGraphConfig, PoseGraphSolution};
pub use pose_prior::PosePrior;

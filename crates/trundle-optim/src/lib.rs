//! Robust least squares on SE(3) over an RGB-D camera's measurements of points.
//!
//! [`PoseProblem`] refines one camera pose against known points (tracking). [`BundleProblem`] refines several poses and the points together
//! by the Schur complement (bundle adjustment, Triggs et al. 2000). [`PoseGraph`] distributes the correction of a closed loop over poses
//! with relative constraints. [`ArrowSystem`] solves a chain of states with common parameters (fixed-lag smoothing). The first two share
//! the residual of [`PointObservation`] (rectified pixel and inverse depth, each in its standard deviations), the Huber loss and the
//! perturbation. Poses are `world_from_camera`, perturbed on the right, translation first: a covariance is that of the camera in its own
//! frame. Everything runs on one thread in a fixed order: the same input gives the same bits.
//!
//! ```
//! use nalgebra::{Matrix6, UnitQuaternion};
//! use trundle_core::{Pose3, Vector3};
//! use trundle_optim::{PoseConstraint, PoseGraph, PoseGraphConfig};
//!
//! // Four poses along a line by odometry, each step 0.1 m too long, and a loop closure that measures 3 m.
//! let at = |x: f64| Pose3::new(UnitQuaternion::identity(), Vector3::x() * x);
//! let constraint = |from, to, length| PoseConstraint { from, to, from_to: at(length), information: Matrix6::identity() };
//! let mut constraints: Vec<PoseConstraint> = (0..3).map(|i| constraint(i, i + 1, 1.1)).collect();
//! constraints.push(PoseConstraint { information: Matrix6::identity() * 1e6, ..constraint(0, 3, 3.0) });
//!
//! let poses = (0..4).map(|i| at(1.1 * f64::from(i))).collect();
//! let graph = PoseGraph::new(poses, &[true, false, false, false], constraints)?;
//! let solution = graph.solve(&PoseGraphConfig::default());
//! for (i, pose) in solution.poses.iter().enumerate() {
//!     assert!((pose.translation.x - i as f64).abs() < 1e-3, "the correction is distributed evenly");
//! }
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

mod arrow;
mod block;
mod block_cholesky;
mod bundle;
mod bundle_layout;
mod bundle_residual;
mod bundle_solver;
mod bundle_system;
mod huber;
mod leverage;
mod narrow_order;
mod observation;
mod pose;
mod pose_graph;
mod pose_prior;
mod static_points;

pub use arrow::{ArrowCovariance, ArrowMarginal, ArrowSystem};
pub use block_cholesky::BlockMatrix;
pub use bundle::{BundleConfig, BundleObservation, BundlePose, BundleProblem, BundleSolution};
pub use bundle_solver::BundleSolver;
pub use huber::Huber;
pub use observation::{CHI2_95_2, CHI2_95_3, CHI2_95_6, InverseDepth, Linearized, PointObservation};
pub use pose::{CORRELATED_POINTS, PoseConfig, PoseProblem, PoseSolution};
pub use pose_graph::{PoseConstraint, PoseGraph, PoseGraphConfig, PoseGraphSolution};
pub use pose_prior::PosePrior;

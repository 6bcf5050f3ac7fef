//! Gauss-Newton optimisation of a pose on the likelihood of scan points and a Gaussian prior.

use crate::particle_config::ParticleConfig;
use crate::scan_match::held_directions::HeldDirections;
use crate::scan_match::likelihood::{Likelihood, ScanEquations};
use crate::scan_match::motion_prior::MotionPrior;
use crate::scan_match::scan_points::ScanPoints;
use nalgebra::{Cholesky, Vector3};
use trundle_core::{Pose2, wrap_angle};
use trundle_grid::tiles::TileWindow;

/// Optimiser of the pose of scan points in a map of tiles.
///
/// The residual of a point is its distance to the nearest obstacle along the normal of its surface. Only the prior moves degenerate
/// directions \[Zhang16\].
#[derive(Debug, Clone, Copy)]
pub(crate) struct PoseOptimizer<'a> {
    pub(crate) config: &'a ParticleConfig,
    pub(crate) likelihood: &'a Likelihood,
    pub(crate) points: &'a ScanPoints,
}

/// Optimum of the posterior.
pub(crate) struct Optimum {
    /// Pose: cells of the window, rad.
    pub(crate) pose: Pose2,
    pub(crate) equations: ScanEquations,
    pub(crate) directions: HeldDirections,
    /// Log-posterior up to a constant, nats.
    pub(crate) log_posterior: f64,
}

/// Maximum number of Gauss-Newton steps. After this number the last pose is used. Source: ours.
const MAX_ITERATIONS: usize = 10;
/// Step length at which the iteration ends \[cells\]. Source: ours.
const MIN_STEP_CELLS: f64 = 0.01;

impl PoseOptimizer<'_> {
    /// Optimum near `start` under `prior`, by Gauss-Newton.
    pub(crate) fn optimize(&self, window: &TileWindow<'_>, prior: &MotionPrior, start: Pose2) -> Optimum {
        let mut pose = start;
        let mut equations = self.likelihood.equations(window, self.points, pose);
        let directions = HeldDirections::new(self.points, pose, &equations, self.config.degenerate_below);
        for _ in 0..MAX_ITERATIONS {
            let scale = 1.0 / self.config.correlation;
            let information =
                directions.information(&equations) * scale + directions.in_y(&prior.information);
            let back = prior.information * difference(prior.guess, pose);
            let rhs = directions.rhs(&equations) * scale + directions.pose_from_y.transpose() * back;
            let Some(factor) = Cholesky::new(information) else { break };
            let step = factor.solve(&rhs);
            let x = directions.pose_from_y * step;
            pose = Pose2 { x: pose.x + x.x, y: pose.y + x.y, theta: pose.theta + x.z };
            equations = self.likelihood.equations(window, self.points, pose);
            if step.amax() < MIN_STEP_CELLS {
                break;
            }
        }
        let directions = HeldDirections::new(self.points, pose, &equations, self.config.degenerate_below);
        Optimum { log_posterior: self.log_posterior(window, prior, pose), pose, equations, directions }
    }

    /// Log-posterior ln p(z | m, x) p(x | prior) up to a constant, nats.
    pub(crate) fn log_posterior(&self, window: &TileWindow<'_>, prior: &MotionPrior, pose: Pose2) -> f64 {
        let off = difference(pose, prior.guess);
        self.likelihood.log_likelihood(window, self.points, pose) / self.config.correlation
            - 0.5 * off.dot(&(prior.information * off))
            + 0.5 * prior.log_determinant
    }
}

/// Difference of two poses: cells, cells, rad.
pub(crate) fn difference(to: Pose2, from: Pose2) -> Vector3<f64> {
    Vector3::new(to.x - from.x, to.y - from.y, wrap_angle(to.theta - from.theta))
}

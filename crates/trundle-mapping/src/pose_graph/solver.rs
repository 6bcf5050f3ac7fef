//! Gauss-Newton solution of the pose graph.

use super::{Constraint, PoseEquations};
use nalgebra::Matrix3;
use trundle_core::Pose2;

/// Poses that minimise the squared residuals of the constraints, the first pose fixed: Gauss-Newton (\[Grisetti10\]).
///
/// `None` if the constraints do not determine all poses, or a number overflows. Cost of an iteration: linear in the poses for a
/// chain with few loops.
pub(crate) fn solve(mut poses: Vec<Pose2>, constraints: &[Constraint]) -> Option<Vec<Pose2>> {
    let information: Vec<Matrix3<f64>> = constraints.iter().map(Constraint::information).collect();
    let pairs: Vec<(usize, usize)> = constraints.iter().map(Constraint::poses).collect();
    let mut equations = PoseEquations::new(poses.len(), &pairs);
    for _ in 0..MAX_ITERATIONS {
        equations.clear();
        for (constraint, information) in constraints.iter().zip(&information) {
            equations.add_constraint(&poses, constraint, information);
        }
        let mut longest = 0.0_f64;
        for (pose, step) in poses.iter_mut().zip(equations.solve()?) {
            *pose = *pose * Pose2::new(step.x, step.y, step.z);
            longest = longest.max(step.amax());
        }
        if longest < MIN_STEP {
            break;
        }
    }
    Some(poses)
}

/// Maximum number of Gauss-Newton steps. After this number the last poses are returned. Source: ours.
const MAX_ITERATIONS: usize = 12;
/// Step length at which the iteration ends \[m, rad\]. Source: ours.
const MIN_STEP: f64 = 1e-3;

#[cfg(test)]
mod tests;

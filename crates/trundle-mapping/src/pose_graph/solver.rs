//! Gauss-Newton solution of the pose graph.

use super::Constraint;
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;
use trundle_optim::BlockMatrix;

/// Poses that minimise the squared residuals of the constraints, the first pose fixed: Gauss-Newton (\[Grisetti10\]).
///
/// `None` if the constraints do not determine all poses, or a number overflows. Cost of an iteration: linear in the poses for a
/// chain with few loops.
pub(crate) fn solve(mut poses: Vec<Pose2>, constraints: &[Constraint]) -> Option<Vec<Pose2>> {
    let information: Vec<Matrix3<f64>> = constraints.iter().map(Constraint::information).collect();
    let pairs: Vec<(usize, usize)> = constraints.iter().map(Constraint::poses).collect();
    let mut matrix = BlockMatrix::new(poses.len(), &pairs);
    for _ in 0..MAX_ITERATIONS {
        let step = step(&mut matrix, &poses, constraints, &information)?;
        let mut longest = 0.0_f64;
        for (pose, step) in poses.iter_mut().zip(&step) {
            *pose = *pose * Pose2::new(step.x, step.y, step.z);
            longest = longest.max(step.amax());
        }
        if !longest.is_finite() {
            return None;
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
/// Information that fixes the first pose [1/m^2, 1/rad^2]. Source: ours.
const FIRST_POSE_INFORMATION: f64 = 1e9;

/// One Gauss-Newton step of each pose, as a right perturbation.
fn step(
    matrix: &mut BlockMatrix<3>,
    poses: &[Pose2],
    constraints: &[Constraint],
    information: &[Matrix3<f64>],
) -> Option<Vec<Vector3<f64>>> {
    matrix.clear();
    let mut rhs = vec![Vector3::zeros(); poses.len()];
    for (constraint, information) in constraints.iter().zip(information) {
        let (i, j) = constraint.poses();
        let residual = constraint.residual(poses[i], poses[j]);
        let (by_from, by_to) = constraint.jacobians(poses[i], poses[j]);
        let (wi, wj) = (by_from.transpose() * information, by_to.transpose() * information);
        matrix.add(i, i, &(wi * by_from));
        matrix.add(j, j, &(wj * by_to));
        matrix.add(i, j, &(wi * by_to));
        rhs[i] -= wi * residual;
        rhs[j] -= wj * residual;
    }
    matrix.add(0, 0, &Matrix3::from_diagonal_element(FIRST_POSE_INFORMATION));
    (matrix.factorise() && matrix.solve(&mut rhs)).then_some(rhs)
}

#[cfg(test)]
mod tests;

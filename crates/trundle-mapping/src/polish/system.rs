//! Gauss-Newton step of all poses of the graph.

use crate::polish::pair::PairEquations;
use crate::pose_graph::Constraint;
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;
use trundle_optim::BlockMatrix;

/// Information that fixes the first pose [1/m^2, 1/rad^2]. Source: ours.
const FIRST_POSE_INFORMATION: f64 = 1e9;

/// Largest number of blocks of the factor, 72 bytes each: 72 MB. Source: ours.
const MAX_BLOCKS: usize = 1_000_000;

/// Sparse normal equations of the steps of all poses, as right perturbations.
#[derive(Debug)]
pub(super) struct System {
    matrix: BlockMatrix<3>,
    rhs: Vec<Vector3<f64>>,
}

impl System {
    /// Zeros for `count` poses that are coupled by `pairs`; `None` if their factor were larger than [`MAX_BLOCKS`].
    pub(super) fn new(count: usize, pairs: &[(usize, usize)]) -> Option<Self> {
        let matrix = BlockMatrix::new_within(count, pairs, MAX_BLOCKS)?;
        Some(Self { matrix, rhs: vec![Vector3::zeros(); count] })
    }

    /// Adds the match of the hits of scan `from` with scan `to`.
    pub(super) fn add_pair(
        &mut self,
        (from, to): (usize, usize),
        to_from_from: Pose2,
        equations: &PairEquations,
    ) {
        // The displacement of the relative pose is Ad(to_from_from) step_from - step_to.
        let adjoint = adjoint(to_from_from);
        let weighted = adjoint.transpose() * equations.information;
        self.matrix.add(from, from, &(weighted * adjoint));
        self.matrix.add(to, to, &equations.information);
        self.matrix.add(from, to, &-weighted);
        self.rhs[from] += adjoint.transpose() * equations.rhs;
        self.rhs[to] -= equations.rhs;
    }

    /// Adds a fraction `share` of the information of a constraint.
    pub(super) fn add_constraint(&mut self, poses: &[Pose2], constraint: &Constraint, share: f64) {
        let (i, j) = constraint.poses();
        let information = constraint.information() * share;
        let residual = constraint.residual(poses[i], poses[j]);
        let (by_from, by_to) = constraint.jacobians(poses[i], poses[j]);
        let (from, to) = (by_from.transpose() * information, by_to.transpose() * information);
        self.matrix.add(i, i, &(from * by_from));
        self.matrix.add(j, j, &(to * by_to));
        self.matrix.add(i, j, &(from * by_to));
        self.rhs[i] -= from * residual;
        self.rhs[j] -= to * residual;
    }

    /// The step of each pose, as a right perturbation (m, m, rad), with the first pose fixed. `None` if the equations do not determine all
    /// steps, or a number overflows.
    pub(super) fn solve(mut self) -> Option<Vec<Vector3<f64>>> {
        self.matrix.add(0, 0, &Matrix3::from_diagonal_element(FIRST_POSE_INFORMATION));
        let is_solved = self.matrix.factorise() && self.matrix.solve(&mut self.rhs);
        (is_solved && self.rhs.iter().flatten().all(|v| v.is_finite())).then_some(self.rhs)
    }
}

/// Adjoint of a pose: the left perturbation with the effect of a right one.
fn adjoint(pose: Pose2) -> Matrix3<f64> {
    let (s, c) = pose.theta.sin_cos();
    Matrix3::new(c, -s, pose.y, s, c, -pose.x, 0.0, 0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_adjoint_moves_a_perturbation_to_the_other_side() {
        let (pose, step) = (Pose2::new(2.0, -1.0, 0.7), Vector3::new(1e-4, -2e-4, 3e-4));
        let (right, left) = (pose * Pose2::exp(step), Pose2::exp(adjoint(pose) * step) * pose);
        assert!(right.distance(&left) < 1e-12 && (right.theta - left.theta).abs() < 1e-12);
    }
}

//! Normal equations of one Gauss-Newton step of all poses.

use super::Constraint;
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;
use trundle_optim::BlockMatrix;

/// Information that fixes the first pose [1/m^2, 1/rad^2]. Source: ours.
pub(super) const FIRST_POSE_INFORMATION: f64 = 1e9;

/// Sparse normal equations of the steps of all poses, as right perturbations (m, m, rad).
#[derive(Debug)]
pub(crate) struct PoseEquations {
    matrix: BlockMatrix<3>,
    rhs: Vec<Vector3<f64>>,
}

impl PoseEquations {
    /// Zeros for `count` poses that are coupled by `pairs`.
    pub(crate) fn new(count: usize, pairs: &[(usize, usize)]) -> Self {
        Self { matrix: BlockMatrix::new(count, pairs), rhs: vec![Vector3::zeros(); count] }
    }

    /// As [`Self::new`]; `None` if the factor had more than `max_blocks` blocks.
    pub(crate) fn new_within(count: usize, pairs: &[(usize, usize)], max_blocks: usize) -> Option<Self> {
        let matrix = BlockMatrix::new_within(count, pairs, max_blocks)?;
        Some(Self { matrix, rhs: vec![Vector3::zeros(); count] })
    }

    /// Sets all equations to zero; the couplings stay.
    pub(crate) fn clear(&mut self) {
        self.matrix.clear();
        self.rhs.fill(Vector3::zeros());
    }

    /// Adds a constraint, weighted by `information` (1/m^2, 1/rad^2).
    pub(crate) fn add_constraint(
        &mut self,
        poses: &[Pose2],
        constraint: &Constraint,
        information: &Matrix3<f64>,
    ) {
        let (i, j) = constraint.poses();
        let residual = constraint.residual(poses[i], poses[j]);
        let (by_from, by_to) = constraint.jacobians(poses[i], poses[j]);
        let (from, to) = (by_from.transpose() * information, by_to.transpose() * information);
        self.matrix.add(i, i, &(from * by_from));
        self.matrix.add(j, j, &(to * by_to));
        self.matrix.add(i, j, &(from * by_to));
        self.rhs[i] -= from * residual;
        self.rhs[j] -= to * residual;
    }

    /// Adds equations of the displacement of `from` relative to `to`, in the frame of `to`: `information` (1/m^2, 1/rad^2) and right-hand
    /// side `rhs` (1/m, 1/rad).
    pub(crate) fn add_relative(
        &mut self,
        (from, to): (usize, usize),
        to_from_from: Pose2,
        information: &Matrix3<f64>,
        rhs: &Vector3<f64>,
    ) {
        // The displacement of the relative pose is Ad(to_from_from) step_from - step_to.
        let adjoint = to_from_from.adjoint();
        let weighted = adjoint.transpose() * information;
        self.matrix.add(from, from, &(weighted * adjoint));
        self.matrix.add(to, to, information);
        self.matrix.add(from, to, &-weighted);
        self.rhs[from] += adjoint.transpose() * rhs;
        self.rhs[to] -= rhs;
    }

    /// The step of each pose, with the first pose fixed; the equations are used up until the next [`Self::clear`]. `None` if they do not
    /// determine all steps, or a number overflows.
    pub(crate) fn solve(&mut self) -> Option<&[Vector3<f64>]> {
        self.matrix.add(0, 0, &Matrix3::from_diagonal_element(FIRST_POSE_INFORMATION));
        let is_solved = self.matrix.factorise() && self.matrix.solve(&mut self.rhs);
        (is_solved && self.rhs.iter().flatten().all(|v| v.is_finite())).then_some(&self.rhs)
    }
}

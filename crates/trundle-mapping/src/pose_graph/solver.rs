//! Gauss-Newton solution of the pose graph.

use super::{Constraint, sparse_blocks::SparseBlocks};
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// The poses that agree best with the ties, the first held: Gauss-Newton on the squared residuals (\[Grisetti10\]).
///
/// `None` where the ties do not hold all poses, or a number overflows.
pub(crate) fn solve(mut poses: Vec<Pose2>, constraints: &[Constraint]) -> Option<Vec<Pose2>> {
    let information: Vec<Matrix3<f64>> = constraints.iter().map(Constraint::information).collect();
    for _ in 0..MAX_ITERATIONS {
        let step = step(&poses, constraints, &information)?;
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

/// Maximum number of Gauss-Newton steps. The last poses are returned beyond it. Source: ours.
const MAX_ITERATIONS: usize = 12;
/// Step length at which the iteration ends [m, rad]. Source: ours.
const MIN_STEP: f64 = 1e-3;

fn step(
    poses: &[Pose2],
    constraints: &[Constraint],
    information: &[Matrix3<f64>],
) -> Option<Vec<Vector3<f64>>> {
    let mut matrix = SparseBlocks::new(poses.len());
    let mut right = vec![Vector3::zeros(); poses.len()];
    for (constraint, information) in constraints.iter().zip(information) {
        let (i, j) = (constraint.from as usize, constraint.to as usize);
        let residual = constraint.residual(poses[i], poses[j]);
        let (by_from, by_to) = constraint.jacobians(poses[i], poses[j]);
        let (wi, wj) = (by_from.transpose() * information, by_to.transpose() * information);
        matrix.add_diagonal(i, &(wi * by_from));
        matrix.add_diagonal(j, &(wj * by_to));
        matrix.add(i, j, &(wi * by_to));
        right[i] -= wi * residual;
        right[j] -= wj * residual;
    }
    matrix.add_diagonal(0, &Matrix3::from_diagonal_element(FIRST_POSE_INFORMATION));
    matrix.solve(right)
}

/// Information that fixes the first pose [1/m^2, 1/rad^2]. Source: ours.
const FIRST_POSE_INFORMATION: f64 = 1e9;

#[cfg(test)]
mod tests {
    use super::*;

    /// Eight poses around a square, each step off by some degrees: the loop closes and the error is spread.
    #[test]
    fn a_loop_spreads_its_error_evenly() {
        let truth: Vec<Pose2> = (0..9)
            .scan(Pose2::IDENTITY, |at, i| {
                let here = *at;
                *at = *at * Pose2::new(2.0, 0.0, if i % 2 == 1 { std::f64::consts::FRAC_PI_2 } else { 0.0 });
                Some(here)
            })
            .collect();
        let covariance = Matrix3::from_diagonal(&Vector3::new(1e-3, 1e-3, 1e-4));
        let wrong = Pose2::new(0.01, 0.0, 0.06);
        let mut constraints: Vec<Constraint> = (0..8)
            .map(|i| Constraint {
                from: i as u32,
                to: i as u32 + 1,
                from_to: truth[i].inverse() * truth[i + 1] * wrong,
                covariance,
            })
            .collect();
        let mut poses = vec![Pose2::IDENTITY];
        for constraint in &constraints {
            poses.push(*poses.last().unwrap() * constraint.from_to);
        }
        assert!(poses[8].distance(&truth[8]) > 0.5);
        constraints.push(Constraint { from: 0, to: 8, from_to: truth[8], covariance: covariance * 1e-3 });
        let solved = solve(poses, &constraints).unwrap();
        for (found, truth) in solved.iter().zip(&truth) {
            assert!(found.distance(truth) < 0.25, "{found:?} {truth:?}");
        }
        assert!(solved[8].distance(&truth[8]) < 0.01);
        // What nothing holds is not solved.
        assert!(solve(vec![Pose2::IDENTITY; 3], &[]).is_none());
    }
}

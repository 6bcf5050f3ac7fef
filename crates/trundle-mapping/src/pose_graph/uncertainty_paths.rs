//! Covariance of each pose relative to one pose, along the least uncertain path.

use crate::pose_graph::Constraint;
use nalgebra::{Matrix2, Matrix3, Vector2};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use trundle_core::Pose2;

/// Uncertainty of a pose relative to another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RelativeUncertainty {
    /// Covariance (m, m, rad) in the map's axes.
    pub(crate) covariance: Matrix3<f64>,
    /// Length of the path along the constraints, m.
    pub(crate) path_length: f64,
}

/// Covariance of every pose relative to pose `from`, composed along the path of constraints with the smallest covariance (\[Olson09b\]): an
/// upper bound of the true one. `None` for a pose without such a path. Cost: n log n.
pub(crate) fn reach(
    poses: &[Pose2],
    constraints: &[Constraint],
    from: usize,
) -> Vec<Option<RelativeUncertainty>> {
    let starts = first_constraints(poses.len(), constraints);
    let mut best: Vec<Option<RelativeUncertainty>> = vec![None; poses.len()];
    let mut heap =
        BinaryHeap::from([Entry { cost: 0.0, pose: from as u32, reached: RelativeUncertainty::HERE }]);
    while let Some(Entry { pose, reached, .. }) = heap.pop() {
        let here = pose as usize;
        if best[here].is_some() {
            continue;
        }
        best[here] = Some(reached);
        for &k in &starts.constraints[starts.first[here]..starts.first[here + 1]] {
            let constraint = &constraints[k as usize];
            let there = if constraint.from == pose { constraint.to } else { constraint.from };
            if best[there as usize].is_none() {
                let next =
                    reached.through(poses[here], poses[there as usize], constraint, constraint.from == pose);
                heap.push(Entry { cost: next.cost(), pose: there, reached: next });
            }
        }
    }
    best
}

impl RelativeUncertainty {
    const HERE: Self =
        Self { covariance: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), path_length: 0.0 };

    /// Position and heading in one number: one radian counts as one metre.
    fn cost(&self) -> f64 {
        self.covariance.trace()
    }

    fn through(&self, here: Pose2, there: Pose2, constraint: &Constraint, forward: bool) -> Self {
        let offset = there.position() - here.position();
        let lever = Matrix3::new(1.0, 0.0, -offset.y, 0.0, 1.0, offset.x, 0.0, 0.0, 1.0);
        // The covariance of the measurement is a perturbation at its second pose.
        let at = if forward { there } else { here };
        let (s, c) = at.theta.sin_cos();
        let turn = Matrix2::new(c, -s, s, c);
        let mut noise = Matrix3::zeros();
        noise
            .fixed_view_mut::<2, 2>(0, 0)
            .copy_from(&(turn * constraint.covariance.fixed_view::<2, 2>(0, 0) * turn.transpose()));
        let cross: Vector2<f64> = turn * constraint.covariance.fixed_view::<2, 1>(0, 2);
        noise.fixed_view_mut::<2, 1>(0, 2).copy_from(&cross);
        noise.fixed_view_mut::<1, 2>(2, 0).copy_from(&cross.transpose());
        noise[(2, 2)] = constraint.covariance[(2, 2)];
        if !forward {
            noise = lever * noise * lever.transpose();
        }
        Self {
            covariance: lever * self.covariance * lever.transpose() + noise,
            path_length: self.path_length + offset.norm(),
        }
    }
}

struct FirstConstraints {
    first: Vec<usize>,
    constraints: Vec<u32>,
}

/// The constraints at each pose.
fn first_constraints(count: usize, constraints: &[Constraint]) -> FirstConstraints {
    let mut first = vec![0; count + 1];
    for constraint in constraints {
        first[constraint.from as usize + 1] += 1;
        first[constraint.to as usize + 1] += 1;
    }
    for i in 0..count {
        first[i + 1] += first[i];
    }
    let mut next = first.clone();
    let mut of = vec![0; 2 * constraints.len()];
    for (k, constraint) in constraints.iter().enumerate() {
        for end in [constraint.from as usize, constraint.to as usize] {
            of[next[end]] = k as u32;
            next[end] += 1;
        }
    }
    FirstConstraints { first, constraints: of }
}

struct Entry {
    cost: f64,
    pose: u32,
    reached: RelativeUncertainty,
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    /// The smallest cost first; of equal costs the lower number.
    fn cmp(&self, other: &Self) -> Ordering {
        other.cost.total_cmp(&self.cost).then(other.pose.cmp(&self.pose))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn a_shortcut_has_less_uncertainty_than_the_longer_path() {
        let poses: Vec<Pose2> = (0..11).map(|i| Pose2::new(f64::from(i), 0.0, 0.0)).collect();
        let covariance = Matrix3::from_diagonal(&Vector3::new(0.01, 0.01, 0.001));
        let constraint = |from: usize, to: usize| Constraint {
            from: from as u32,
            to: to as u32,
            from_to: poses[from].inverse() * poses[to],
            covariance,
        };
        let mut constraints: Vec<Constraint> = (0..10).map(|i| constraint(i, i + 1)).collect();
        let around = reach(&poses, &constraints, 10)[0].unwrap();
        assert!((around.covariance[(0, 0)] - 0.1).abs() < 1e-9, "along: ten steps");
        assert!(around.covariance[(1, 1)] > 0.3, "across: the headings' error with their levers");
        constraints.push(constraint(0, 10));
        let across = reach(&poses, &constraints, 10)[0].unwrap();
        assert!(across.covariance.trace() < 0.5 * around.covariance.trace());
    }
}

use crate::bundle::BundleProblem;
use crate::observation::camera_point_by_pose;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, Matrix6x3, SVector, Vector6};
use std::ops::Range;
use trundle_core::{PinholeCamera, Pose3, Vector3};

/// The normal equations of a bundle problem, kept in blocks: free poses, points, and their couplings.
#[derive(Debug, Default)]
pub(crate) struct Normal {
    poses: Vec<(Matrix6<f64>, Vector6<f64>)>,
    points: Vec<PointBlock>,
    couplings: Vec<Coupling>,
}

/// A point's own block, its gradient, and where its couplings are.
#[derive(Debug)]
struct PointBlock {
    hessian: Matrix3<f64>,
    gradient: Vector3,
    couplings: Range<usize>,
}

/// The block between free pose `pose` and a point.
#[derive(Debug)]
struct Coupling {
    pose: usize,
    block: Matrix6x3<f64>,
}

/// How far everything moves.
#[derive(Debug)]
pub(crate) struct Step {
    /// One right perturbation for each free pose.
    pub poses: Vec<Vector6<f64>>,
    /// One displacement for each point, m.
    pub points: Vec<Vector3>,
}

impl Normal {
    /// J'WJ and J'Wr at the problem's poses and points.
    pub fn build(&mut self, problem: &BundleProblem, camera: &PinholeCamera) {
        let slots = free_slots(problem);
        self.poses.clear();
        self.poses.resize(slots.iter().flatten().count(), (Matrix6::zeros(), Vector6::zeros()));
        self.points.clear();
        self.couplings.clear();
        let views: Vec<(Pose3, Matrix3<f64>)> = problem
            .poses
            .iter()
            .map(|p| p.world_from_camera.inverse())
            .map(|i| (i, i.rotation_matrix()))
            .collect();
        let mut next = 0;
        for (index, point) in problem.points.iter().enumerate() {
            let start = self.couplings.len();
            let (mut hessian, mut gradient) = (Matrix3::zeros(), Vector3::zeros());
            while let Some(o) = problem.observations.get(next).filter(|o| o.point == index) {
                next += 1;
                let (camera_from_world, rotation) = &views[o.pose];
                let p_camera = camera_from_world.transform(*point);
                let Some(linear) = o.seen.linearize(camera, p_camera) else { continue };
                let weight = o.seen.huber().weight(linear.residual.norm_squared());
                let by_world = linear.by_point * rotation;
                let weighted = by_world.transpose() * weight;
                hessian += weighted * by_world;
                gradient += weighted * linear.residual;
                let Some(pose) = slots[o.pose] else { continue };
                let by_pose = linear.by_point * camera_point_by_pose(p_camera);
                let weighted = by_pose.transpose() * weight;
                self.poses[pose].0 += weighted * by_pose;
                self.poses[pose].1 += weighted * linear.residual;
                self.couplings.push(Coupling { pose, block: weighted * by_world });
            }
            self.points.push(PointBlock { hessian, gradient, couplings: start..self.couplings.len() });
        }
    }

    /// The damped step: points eliminated, reduced camera system by Cholesky, points back-substituted.
    /// `None` when the system is not positive definite at this damping.
    pub fn solve(&self, damping: f64) -> Option<Step> {
        let inverses: Vec<Option<Matrix3<f64>>> =
            self.points.iter().map(|p| damped(p.hessian, damping).cholesky().map(|c| c.inverse())).collect();
        let poses = self.reduced_step(&inverses, damping)?;
        let point = |(block, inverse): (&PointBlock, &Option<Matrix3<f64>>)| {
            let Some(inverse) = inverse else { return Vector3::zeros() };
            let moved = self.couplings[block.couplings.clone()]
                .iter()
                .fold(block.gradient, |sum, c| sum + c.block.transpose() * poses[c.pose]);
            -(inverse * moved)
        };
        let points = self.points.iter().zip(&inverses).map(point).collect();
        Some(Step { poses, points })
    }

    /// S = U - W V^-1 W', solved for the poses.
    fn reduced_step(&self, inverses: &[Option<Matrix3<f64>>], damping: f64) -> Option<Vec<Vector6<f64>>> {
        if self.poses.is_empty() {
            return Some(Vec::new());
        }
        let size = self.poses.len() * 6;
        let (mut reduced, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for (i, (hessian, gradient)) in self.poses.iter().enumerate() {
            reduced.fixed_view_mut::<6, 6>(i * 6, i * 6).copy_from(&damped(*hessian, damping));
            right.fixed_rows_mut::<6>(i * 6).copy_from(&-gradient);
        }
        for (block, inverse) in self.points.iter().zip(inverses) {
            let Some(inverse) = inverse else { continue };
            let couplings = &self.couplings[block.couplings.clone()];
            for a in couplings {
                let eliminated = a.block * inverse;
                let mut rows = right.fixed_rows_mut::<6>(a.pose * 6);
                rows += eliminated * block.gradient;
                for b in couplings.iter().filter(|b| b.pose <= a.pose) {
                    let mut view = reduced.fixed_view_mut::<6, 6>(a.pose * 6, b.pose * 6);
                    view -= eliminated * b.block.transpose();
                }
            }
        }
        let step = reduced.cholesky()?.solve(&right);
        let poses: Vec<Vector6<f64>> =
            (0..self.poses.len()).map(|i| step.fixed_rows::<6>(i * 6).into_owned()).collect();
        poses.iter().all(|p| p.iter().all(|v| v.is_finite())).then_some(poses)
    }
}

/// Which free pose each pose is.
fn free_slots(problem: &BundleProblem) -> Vec<Option<usize>> {
    let mut free = 0..;
    problem.poses.iter().map(|pose| if pose.fixed { None } else { free.next() }).collect()
}

/// Marquardt's damping: the diagonal grows by the given part of itself.
fn damped<const N: usize>(
    mut hessian: nalgebra::SMatrix<f64, N, N>,
    damping: f64,
) -> nalgebra::SMatrix<f64, N, N> {
    let diagonal: SVector<f64, N> = hessian.diagonal();
    for i in 0..N {
        hessian[(i, i)] += diagonal[i] * damping;
    }
    hessian
}

//! The normal equations of a bundle problem.

use crate::block::{Block, Column, subtract_outer};
use crate::block_cholesky::BlockMatrix;
use crate::bundle_layout::{Layout, Measurement};
use crate::bundle_residual::{FIXED_ROW, Lens, View, cross, dot, robust};
use crate::observation::{CHI2_95_6, COST_BEHIND_CAMERA, MIN_PROJECTION_DEPTH_M};
use crate::pose_graph::PoseConstraint;
use nalgebra::{Matrix6, Vector6};
use trundle_core::{Pose3, Vector3};

/// Coupling of an observation's pose and point: with M = [-I | p^], the derivative of p by the pose, the block between
/// them is M' `coupling`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coupling {
    /// The point in the camera's frame, m.
    p: [f64; 3],
    /// Information between camera frame and world frame, by columns.
    coupling: [[f64; 3]; 3],
}

const UNCOUPLED: Coupling = Coupling { p: [0.0; 3], coupling: [[0.0; 3]; 3] };

/// A point's own block (upper half by rows) and gradient.
#[derive(Debug, Clone, Copy, Default)]
struct PointBlock {
    hessian: [f64; 6],
    gradient: [f64; 3],
    /// Inverse of the damped block, upper half by rows; zero if singular.
    inverse: [f64; 6],
}

/// The normal equations of a bundle problem J'WJ and J'Wr, in blocks, and the reduced system of the poses.
#[derive(Debug, Clone, Default)]
pub(crate) struct Normal {
    /// Blocks of poses, by row.
    poses: Vec<(Block, Column)>,
    points: Vec<PointBlock>,
    couplings: Vec<Coupling>,
    /// Coupling of two rows by constraints, the lower row first.
    crossed: Vec<(u32, u32, Matrix6<f64>)>,
    /// S = U - W V^-1 W' \[Triggs et al. 2000\].
    pub reduced: BlockMatrix,
    /// Right-hand side by node, then the step.
    pub step: Vec<Vector6<f64>>,
    /// Node of each row.
    node_of: Vec<usize>,
    /// Blocks of the present point between pose and point, and these times the inverse of the point's own.
    wide: Vec<(u32, [Column; 3], [Column; 3])>,
}

impl Normal {
    /// Makes room for a problem whose reduced system has the right shape already.
    pub fn fit(&mut self, layout: &Layout, points: usize) {
        let free = self.reduced.count();
        self.node_of.clear();
        self.node_of.resize(free, 0);
        (0..free).for_each(|node| self.node_of[self.reduced.row(node)] = node);
        self.poses.resize(free, ([[0.0; 6]; 6], [0.0; 6]));
        self.points.resize(points, PointBlock::default());
        self.couplings.resize(layout.seen.len(), UNCOUPLED);
        self.step.resize(free, Vector6::zeros());
    }

    /// Restarts at other poses and points.
    pub fn clear(&mut self) {
        self.poses.fill(([[0.0; 6]; 6], [0.0; 6]));
        self.crossed.clear();
    }

    /// Adds a constraint between the poses of two rows; its robust cost.
    pub fn add_constraint(&mut self, constraint: &PoseConstraint, poses: &[Pose3], views: &[View]) -> f64 {
        let (residual, by_from, by_to) = constraint.linearise(poses);
        let chi2 = residual.dot(&(constraint.information * residual));
        let (loss, weight) = robust(chi2, CHI2_95_6);
        let information = constraint.information * weight;
        let sides = [(views[constraint.from].row, by_from), (views[constraint.to].row, by_to)];
        for (row, jacobian) in sides.iter().filter(|(row, _)| *row != FIXED_ROW) {
            let (block, gradient) = &mut self.poses[*row as usize];
            let own: Matrix6<f64> = jacobian.transpose() * information * jacobian;
            let pull: Vector6<f64> = jacobian.transpose() * information * residual;
            for (column, sum) in block.iter_mut().enumerate() {
                (0..6).for_each(|row| sum[row] += own[(row, column)]);
                gradient[column] += pull[column];
            }
        }
        let [(from, by_from), (to, by_to)] = sides;
        if from != FIXED_ROW && to != FIXED_ROW {
            let mixed: Matrix6<f64> = by_from.transpose() * information * by_to;
            self.crossed.push(if from < to { (from, to, mixed.transpose()) } else { (to, from, mixed) });
        }
        loss
    }

    /// Adds the observations of a point; its robust cost by `loss_of`, [`refining`] or [`certain`].
    #[inline(always)]
    pub fn linearise(
        &mut self,
        (index, point): (usize, &[f64; 3]),
        layout: &Layout,
        views: &[View],
        lens: &Lens,
        loss_of: impl Fn(f64, &Measurement) -> (f64, f64),
    ) -> f64 {
        let range = layout.of_point(index);
        let mut block = PointBlock::default();
        let mut cost = 0.0;
        for (seen, kept) in layout.seen[range.clone()].iter().zip(&mut self.couplings[range]) {
            let view = &views[seen.pose as usize];
            *kept = UNCOUPLED;
            let p = view.camera_point(point);
            if p[2] < MIN_PROJECTION_DEPTH_M {
                cost += COST_BEHIND_CAMERA;
                continue;
            }
            let inverse = 1.0 / p[2];
            let r = lens.residual(seen, &p, inverse);
            let (loss, weight) = loss_of(dot(&r, &r), seen);
            cost += loss;
            // Derivative of the residual by p: rows (a, 0, -a x), (0, b, -b y), (0, 0, c).
            let (x, y) = (p[0] * inverse, p[1] * inverse);
            let (a, b) = (lens.fx * inverse * seen.per_px, lens.fy * inverse * seen.per_px);
            let c = -inverse * inverse * seen.per_depth;
            let (aa, bb) = (weight * a * a, weight * b * b);
            let info = [
                [aa, 0.0, -aa * x],
                [0.0, bb, -bb * y],
                [-aa * x, -bb * y, aa * x * x + bb * y * y + weight * c * c],
            ];
            let g = [weight * a * r[0], weight * b * r[1], weight * (c * r[2] - a * x * r[0] - b * y * r[1])];
            let rotation = &view.rotation;
            // Columns of info * rotation.
            let coupling: [[f64; 3]; 3] = std::array::from_fn(|j| {
                let column = [rotation[0][j], rotation[1][j], rotation[2][j]];
                [
                    info[0][0] * column[0] + info[0][2] * column[2],
                    info[1][1] * column[1] + info[1][2] * column[2],
                    dot(&info[2], &column),
                ]
            });
            let mut entry = 0;
            for i in 0..3 {
                let column = [rotation[0][i], rotation[1][i], rotation[2][i]];
                for other in &coupling[i..] {
                    block.hessian[entry] += dot(&column, other);
                    entry += 1;
                }
                block.gradient[i] += dot(&column, &g);
            }
            if view.row != FIXED_ROW {
                *kept = Coupling { p, coupling };
                add_pose(&mut self.poses[view.row as usize], &info, &g, &p);
            }
        }
        self.points[index] = block;
        cost
    }

    /// Covariance of the pose of a row, once the reduced system is inverted.
    pub fn covariance_of(&self, row: u32) -> Matrix6<f64> {
        self.reduced.inverse_of(self.node_of[row as usize])
    }

    /// Information on the pose of a row with every point fixed.
    pub fn information_of(&self, row: u32) -> Matrix6<f64> {
        Matrix6::from_data(nalgebra::ArrayStorage(self.poses[row as usize].0))
    }

    /// Step of the pose of a row, after the reduced system is solved.
    pub fn step_of(&self, row: u32) -> Vector6<f64> {
        self.step[self.node_of[row as usize]]
    }

    /// Starts the reduced system at this damping: the poses' own blocks.
    pub fn begin_reduced(&mut self, damping: f64) {
        self.reduced.clear();
        for (row, (hessian, gradient)) in self.poses.iter().enumerate() {
            let block = self.reduced.block_mut(row, row);
            *block = *hessian;
            (0..6).for_each(|k| block[k][k] += block[k][k] * damping);
            self.step[self.node_of[row]] = -Vector6::from(*gradient);
        }
        for (low, high, mixed) in &self.crossed {
            let block = self.reduced.block_mut(*high as usize, *low as usize);
            for (column, sum) in block.iter_mut().enumerate() {
                (0..6).for_each(|row| sum[row] += mixed[(row, column)]);
            }
        }
    }

    /// Eliminates a range of points from the system.
    pub fn eliminate(
        &mut self,
        points: std::ops::Range<usize>,
        damping: f64,
        layout: &Layout,
        views: &[View],
    ) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx") {
            // SAFETY: the processor has the only feature that the function is compiled for.
            return unsafe { self.eliminate_by_avx(points, damping, layout, views) };
        }
        self.eliminate_plainly(points, damping, layout, views);
    }

    /// The same as [`Normal::eliminate_plainly`] with four numbers to an operation.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx")]
    fn eliminate_by_avx(
        &mut self,
        points: std::ops::Range<usize>,
        damping: f64,
        layout: &Layout,
        views: &[View],
    ) {
        self.eliminate_plainly(points, damping, layout, views);
    }

    #[inline(always)]
    fn eliminate_plainly(
        &mut self,
        points: std::ops::Range<usize>,
        damping: f64,
        layout: &Layout,
        views: &[View],
    ) {
        for index in points {
            let block = &mut self.points[index];
            block.inverse = inverse(&block.hessian, damping);
            let (inverse, gradient) = (full(&block.inverse), block.gradient);
            self.wide.clear();
            let range = layout.of_point(index);
            for (seen, kept) in layout.seen[range.clone()].iter().zip(&self.couplings[range]) {
                let row = views[seen.pose as usize].row;
                if row == FIXED_ROW {
                    break;
                }
                let wide = kept.wide();
                let eliminated: [Column; 3] = std::array::from_fn(|j| {
                    std::array::from_fn(|row| {
                        wide[0][row] * inverse[0][j]
                            + wide[1][row] * inverse[1][j]
                            + wide[2][row] * inverse[2][j]
                    })
                });
                let right = &mut self.step[self.node_of[row as usize]];
                for (row, sum) in right.iter_mut().enumerate() {
                    *sum += eliminated[0][row] * gradient[0]
                        + eliminated[1][row] * gradient[1]
                        + eliminated[2][row] * gradient[2];
                }
                self.wide.push((row, wide, eliminated));
                let last = self.wide.len() - 1;
                for (i, (other, wide, other_eliminated)) in self.wide.iter().enumerate() {
                    let block = self.reduced.block_mut(row as usize, *other as usize);
                    subtract_outer(block, &eliminated, wide);
                    if *other == row && i < last {
                        // A pose that observes a point twice.
                        subtract_outer(block, other_eliminated, &self.wide[last].1);
                    }
                }
            }
        }
    }

    /// Step of a point, given the poses' step, m.
    #[inline(always)]
    pub fn point_step(&self, index: usize, layout: &Layout, views: &[View]) -> [f64; 3] {
        let block = &self.points[index];
        let mut sum = block.gradient;
        let range = layout.of_point(index);
        for (seen, kept) in layout.seen[range.clone()].iter().zip(&self.couplings[range]) {
            let row = views[seen.pose as usize].row;
            if row == FIXED_ROW {
                break;
            }
            let step = &self.step[self.node_of[row as usize]];
            let turned = cross(&kept.p, &[step[3], step[4], step[5]]);
            let moved = [turned[0] - step[0], turned[1] - step[1], turned[2] - step[2]];
            (0..3).for_each(|j| sum[j] += dot(&kept.coupling[j], &moved));
        }
        let inverse = full(&block.inverse);
        std::array::from_fn(|i| -dot(&inverse[i], &sum))
    }
}

impl Coupling {
    /// M' coupling, by columns: (-c, -p x c) for each column c.
    #[inline(always)]
    fn wide(&self) -> [Column; 3] {
        std::array::from_fn(|j| {
            let c = &self.coupling[j];
            let turned = cross(c, &self.p);
            [-c[0], -c[1], -c[2], turned[0], turned[1], turned[2]]
        })
    }
}

/// Adds M' info M and M' g to a pose's block and gradient.
#[inline(always)]
fn add_pose((block, gradient): &mut (Block, Column), info: &[[f64; 3]; 3], g: &[f64; 3], p: &[f64; 3]) {
    // Rows of info p^, which are cross products.
    let turned: [[f64; 3]; 3] = std::array::from_fn(|i| cross(&info[i], p));
    for j in 0..3 {
        // Column j of info, and of -info p^ with p^ info p^ ... below it.
        let column = [turned[0][j], turned[1][j], turned[2][j]];
        let below = cross(&column, p);
        for i in 0..3 {
            block[j][i] += info[i][j];
            block[j + 3][i] -= turned[i][j];
            block[j][i + 3] -= turned[j][i];
            block[j + 3][i + 3] += below[i];
        }
        gradient[j] -= g[j];
    }
    let turned = cross(g, p);
    (0..3).for_each(|i| gradient[i + 3] += turned[i]);
}

/// The inverse of a symmetric block (upper halves by rows) whose diagonal is enlarged by a part of itself; zero if singular.
#[inline(always)]
fn inverse(hessian: &[f64; 6], damping: f64) -> [f64; 6] {
    let [a, b, c, d, e, f] = *hessian;
    let (a, d, f) = (a + a * damping, d + d * damping, f + f * damping);
    let (ca, cb, cc) = (d * f - e * e, c * e - b * f, b * e - c * d);
    let determinant = a * ca + b * cb + c * cc;
    let positive = a > 0.0 && a * d - b * b > 0.0 && determinant > 0.0;
    let s = 1.0 / determinant;
    if !(positive && s.is_finite()) {
        return [0.0; 6];
    }
    [ca * s, cb * s, cc * s, (a * f - c * c) * s, (b * c - a * e) * s, (a * d - b * b) * s]
}

#[inline(always)]
fn full(half: &[f64; 6]) -> [[f64; 3]; 3] {
    let [a, b, c, d, e, f] = *half;
    [[a, b, c], [b, d, e], [c, e, f]]
}

/// A point moved by a step.
#[inline(always)]
pub(crate) fn moved(point: &Vector3, step: &[f64; 3]) -> Vector3 {
    Vector3::new(point.x + step[0], point.y + step[1], point.z + step[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bundle_residual::refining;
    use crate::{BundleObservation, BundlePose, BundleProblem, PointObservation};
    use trundle_core::{PinholeCamera, Vector2};

    #[test]
    fn four_numbers_to_an_operation_change_nothing() {
        let camera = PinholeCamera::kinect_v1();
        let pose = |i: usize| Pose3::exp(Vector6::new(0.1 * i as f64, 0.02, 0.0, 0.1, 0.05 * i as f64, 0.0));
        let points: Vec<Vector3> = (0..9).map(|i| Vector3::new(0.1 * f64::from(i), 0.3, 2.0)).collect();
        let mut observations = Vec::new();
        for i in 0..4 {
            for point in 0..points.len() {
                let pixel = Vector2::new(300.0 + 7.0 * i as f64, 200.0 + 9.0 * point as f64);
                let seen = PointObservation { pixel, pixel_sigma: 1.0, depth: None };
                observations.push(BundleObservation { pose: i, point, seen });
            }
        }
        let poses = (0..4).map(|i| BundlePose { world_from_camera: pose(i), fixed: false }).collect();
        let problem = BundleProblem::new(camera, poses, points.clone(), observations).unwrap();
        let views: Vec<View> = (0..4).map(|i| View::of(&pose(i), i as u32)).collect();
        let mut layout = Layout::default();
        layout.fill(&problem, |pose| pose as u32);
        let mut plain = Normal::default();
        plain.reduced.shape_full(4);
        plain.fit(&layout, points.len());
        for (i, point) in points.iter().enumerate() {
            plain.linearise((i, &(*point).into()), &layout, &views, &Lens::of(&camera), refining);
        }
        plain.begin_reduced(1e-4);
        let mut fast = plain.clone();
        plain.eliminate_plainly(0..9, 1e-4, &layout, &views);
        fast.eliminate(0..9, 1e-4, &layout, &views);
        for i in 0..4 {
            for j in 0..=i {
                assert_eq!(plain.reduced.block_mut(i, j), fast.reduced.block_mut(i, j));
            }
        }
        assert_eq!(plain.step, fast.step);
        assert!(plain.step.iter().all(|step| step.norm() > 0.0));
    }
}

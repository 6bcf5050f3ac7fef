//! Solves a bundle problem in slices of work.

use crate::bundle::{BundleConfig, BundleProblem, BundleSolution};
use crate::bundle_layout::Layout;
use crate::bundle_residual::{FIXED_ROW, Lens, View, certain, refining, robust};
use crate::bundle_system::{Normal, moved};
use crate::observation::CHI2_95_6;
use crate::pose_graph::PoseConstraint;
use nalgebra::Matrix6;
use trundle_core::{Pose3, Vector3};

/// Maximum number of free poses for a dense reduced system: 64. With more poses, poses without a common point are not coupled, which saves
/// time. Source: ours.
const MAX_DENSE_POSES: usize = 64;
/// Units of work of [`BundleSolver::advance`] to linearise an observation: 4. One unit takes some 20 ns. Source: ours, measured.
const WORK_PER_OBSERVATION: usize = 4;
/// Units of work for a product of two 6 x 6 blocks: 3. Source: as [`WORK_PER_OBSERVATION`].
const WORK_PER_PRODUCT: usize = 3;
/// Units of work for a constraint: 60. Source: as [`WORK_PER_OBSERVATION`].
const WORK_PER_CONSTRAINT: usize = 60;

/// A running bundle adjustment by the Schur complement (Triggs et al. 2000).
///
/// Levenberg-Marquardt on the Huber loss. The points are eliminated, 3 x 3 each; the reduced system of the poses is solved by a block
/// Cholesky factor. Cost of a step: O(sum over points of (poses with this point)^2 + poses x profile^2). Buffers are reused from one
/// problem to the next: once they have grown, no memory is allocated. The work can be cut into slices; the result is the same bit for bit.
///
/// ```
/// # use trundle_optim::{BundleConfig, BundleProblem, BundleSolver};
/// # fn refine(problem: &BundleProblem) {
/// let mut solver = BundleSolver::default();
/// solver.begin(problem, &BundleConfig::default());
/// while !solver.advance(100_000) { /* something more urgent */ }
/// let refined = solver.points();
/// # }
/// ```
#[derive(Debug, Clone, Default)]
pub struct BundleSolver {
    config: BundleConfig,
    lens: Lens,
    layout: Layout,
    normal: Normal,
    here: State,
    /// Poses and points after the present step.
    there: State,
    rows: Vec<u32>,
    constraints: Vec<PoseConstraint>,
    pairs: Vec<(usize, usize)>,
    progress: Progress,
    damping: f64,
    costs: Costs,
    steps: usize,
    chi2: Vec<f64>,
    /// State of the poses' covariances: in computation, or done.
    ending: Ending,
}

/// Phase of a step, and its progress.
#[derive(Debug, Clone, Copy, Default)]
struct Progress {
    phase: Phase,
    /// Next point or row of the phase.
    cursor: usize,
}

/// Robust costs.
#[derive(Debug, Clone, Copy, Default)]
struct Costs {
    /// At the present state.
    present: f64,
    /// Of the problem as given.
    initial: f64,
    /// Sum over the points so far, in the present phase.
    partial: f64,
}

/// State of the covariances.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Ending {
    #[default]
    Refining,
    WorkingOut,
    WorkedOut,
}

/// Damping of the system that the covariances are read from: 1e-9, which keeps the system definite. Source: ours.
const COVARIANCE_DAMPING: f64 = 1e-9;

#[derive(Debug, Clone, Default)]
struct State {
    poses: Vec<Pose3>,
    views: Vec<View>,
    points: Vec<Vector3>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Phase {
    /// Residuals and derivatives of every point.
    Linearise,
    /// Every point taken out of the system of the poses.
    Eliminate,
    /// Factorises the system, row by row.
    Factorise,
    /// Moves the points after the poses, and computes the cost.
    Move,
    /// The remaining residual of every observation.
    Judge,
    /// The inverse of the factor, block by block.
    Invert,
    #[default]
    Done,
}

impl BundleSolver {
    /// Begins a problem; a running one is dropped.
    pub fn begin(&mut self, problem: &BundleProblem, config: &BundleConfig) {
        self.config = config.clone();
        self.lens = Lens::of(&problem.camera);
        self.number_rows(problem);
        let Self { layout, rows, here, .. } = self;
        layout.fill(problem, |pose| rows[pose]);
        self.constraints.clone_from(&problem.constraints);
        here.poses.clear();
        here.poses.extend(problem.poses.iter().map(|p| p.world_from_camera));
        here.points.clone_from(&problem.points);
        here.compute_views(rows);
        self.there.poses.clone_from(&here.poses);
        self.there.points.clone_from(&here.points);
        self.normal.fit(&self.layout, problem.points.len());
        self.chi2.clear();
        self.chi2.resize(problem.observations.len(), f64::INFINITY);
        (self.damping, self.steps, self.costs.present) = (config.damping, 0, f64::INFINITY);
        self.ending = Ending::Refining;
        self.enter(Phase::Linearise);
    }

    /// Continues for about `work` units, some 20 ns each; `true` at the end.
    pub fn advance(&mut self, work: usize) -> bool {
        let mut left = isize::try_from(work).unwrap_or(isize::MAX);
        while self.progress.phase != Phase::Done && left > 0 {
            left -= self.work_on() as isize;
        }
        self.progress.phase == Phase::Done
    }

    /// Goes on to the end.
    pub fn finish(&mut self) {
        while !self.advance(usize::MAX) {}
    }

    /// `world_from_camera` of every pose at the present state.
    pub fn poses(&self) -> &[Pose3] {
        &self.here.poses
    }

    /// Every point at the present state, world frame, m.
    pub fn points(&self) -> &[Vector3] {
        &self.here.points
    }

    /// Squared residual of every observation in the order given, once it is done; infinite behind a camera.
    pub fn chi2(&self) -> &[f64] {
        &self.chi2
    }

    /// Covariance of a pose as a right perturbation (m, rad), with fixed poses and sigmas taken as exact. Available at the end if the
    /// configuration requests it and the pose is free and determined.
    pub fn covariance(&self, pose: usize) -> Option<Matrix6<f64>> {
        let row = self.rows.get(pose).filter(|row| **row != FIXED_ROW && self.ending == Ending::WorkedOut)?;
        Some(self.normal.covariance_of(*row)).filter(|c| c.iter().all(|value| value.is_finite()))
    }

    /// Inverse of the covariance that a free pose would have if all points were known, on the same conditions.
    pub fn information(&self, pose: usize) -> Option<Matrix6<f64>> {
        let row = self.rows.get(pose).filter(|row| **row != FIXED_ROW && self.ending == Ending::WorkedOut)?;
        Some(self.normal.information_of(*row))
    }

    /// Robust cost of the problem as given.
    pub fn initial_cost(&self) -> f64 {
        self.costs.initial
    }

    /// Robust cost at the present state.
    pub fn cost(&self) -> f64 {
        self.costs.present
    }

    /// Steps tried.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Gives every free pose a row of the reduced system.
    fn number_rows(&mut self, problem: &BundleProblem) {
        let free = problem.poses.iter().filter(|pose| !pose.fixed).count();
        let mut node = 0..;
        self.rows.clear();
        let numbers = problem
            .poses
            .iter()
            .map(|pose| if pose.fixed { FIXED_ROW } else { node.next().unwrap_or(FIXED_ROW) });
        self.rows.extend(numbers);
        let reduced = &mut self.normal.reduced;
        if free <= MAX_DENSE_POSES {
            reduced.shape_full(free);
        } else {
            coupled(problem, &self.rows, free, &mut self.pairs);
            reduced.shape(free, &self.pairs);
        }
        for row in self.rows.iter_mut().filter(|row| **row != FIXED_ROW) {
            *row = reduced.row(*row as usize) as u32;
        }
    }

    fn enter(&mut self, phase: Phase) {
        self.progress = Progress { phase, cursor: 0 };
        self.costs.partial = 0.0;
        match phase {
            Phase::Linearise => self.normal.clear(),
            Phase::Eliminate => self.normal.begin_reduced(self.damping),
            Phase::Invert => self.normal.reduced.begin_inverse(),
            _ => {}
        }
    }

    /// Runs one piece of work; returns its units.
    fn work_on(&mut self) -> usize {
        match self.progress.phase {
            Phase::Linearise => self.linearise(),
            Phase::Eliminate => self.eliminate(),
            Phase::Factorise => self.factorise(),
            Phase::Move => self.move_points(),
            Phase::Judge => self.judge(),
            Phase::Invert => self.invert(),
            Phase::Done => 0,
        }
    }

    /// The next points, and whether they are the last.
    fn chunk(&mut self) -> (std::ops::Range<usize>, bool) {
        const POINTS_PER_CHUNK: usize = 32;
        let count = self.here.points.len();
        let range = self.progress.cursor..(self.progress.cursor + POINTS_PER_CHUNK).min(count);
        self.progress.cursor = range.end;
        (range.clone(), range.end == count)
    }

    fn observations(&self, points: &std::ops::Range<usize>) -> usize {
        points.clone().map(|point| self.layout.of_point(point).len()).sum()
    }

    fn linearise(&mut self) -> usize {
        let (points, last) = self.chunk();
        for index in points.clone() {
            let point = (index, &self.here.points[index].into());
            let Self { normal, layout, here, lens, .. } = self;
            self.costs.partial += if self.ending == Ending::WorkingOut {
                normal.linearise(point, layout, &here.views, lens, certain)
            } else {
                normal.linearise(point, layout, &here.views, lens, refining)
            };
        }
        if last {
            for constraint in &self.constraints {
                self.costs.partial +=
                    self.normal.add_constraint(constraint, &self.here.poses, &self.here.views);
            }
            if self.steps == 0 {
                (self.costs.present, self.costs.initial) = (self.costs.partial, self.costs.partial);
            }
            self.enter(Phase::Eliminate);
        }
        WORK_PER_OBSERVATION * self.observations(&points)
            + if last { WORK_PER_CONSTRAINT * self.constraints.len() } else { 0 }
    }

    fn eliminate(&mut self) -> usize {
        let (points, last) = self.chunk();
        self.normal.eliminate(points.clone(), self.damping, &self.layout, &self.here.views);
        if last {
            self.steps += usize::from(self.ending == Ending::Refining);
            self.enter(Phase::Factorise);
        }
        let pairs = |point: usize| self.layout.of_point(point).len().pow(2) / 2 + 1;
        points.map(pairs).sum()
    }

    fn factorise(&mut self) -> usize {
        let row = self.progress.cursor;
        self.progress.cursor += 1;
        let reduced = &mut self.normal.reduced;
        if row < reduced.count() {
            let work = reduced.row_work(row) * WORK_PER_PRODUCT;
            if !reduced.factorise_row(row) {
                self.refuse();
            }
            return work;
        }
        if self.ending == Ending::WorkingOut {
            self.enter(Phase::Invert);
            return 1;
        }
        if !self.normal.reduced.solve(&mut self.normal.step) {
            self.refuse();
            return 1;
        }
        for (i, row) in self.rows.iter().enumerate().filter(|(_, row)| **row != FIXED_ROW) {
            let step = self.normal.step_of(*row);
            self.there.poses[i] = (self.here.poses[i] * Pose3::exp(step)).renormalized();
        }
        self.there.compute_views(&self.rows);
        self.enter(Phase::Move);
        reduced_work(self.rows.len())
    }

    fn move_points(&mut self) -> usize {
        let (points, last) = self.chunk();
        for index in points.clone() {
            let step = self.normal.point_step(index, &self.layout, &self.here.views);
            let point = moved(&self.here.points[index], &step);
            self.there.points[index] = point;
            for seen in &self.layout.seen[self.layout.of_point(index)] {
                let chi2 = self.lens.chi2(&self.there.views[seen.pose as usize], seen, &point.into());
                self.costs.partial += robust(chi2, seen.bound).0;
            }
        }
        let work = self.observations(&points);
        if last {
            let cost = |constraint: &PoseConstraint| robust(constraint.chi2(&self.there.poses), CHI2_95_6).0;
            self.costs.partial += self.constraints.iter().map(cost).sum::<f64>();
            self.decide();
        }
        work
    }

    /// Accepts or rejects the step.
    fn decide(&mut self) {
        if self.costs.partial > self.costs.present {
            return self.refuse();
        }
        let gain = self.costs.present - self.costs.partial;
        self.costs.present = self.costs.partial;
        std::mem::swap(&mut self.here, &mut self.there);
        self.damping = (self.damping * 0.1).max(1e-9);
        let converged = gain <= self.config.converged * self.costs.present;
        self.enter(if converged || self.steps >= self.config.steps {
            Phase::Judge
        } else {
            Phase::Linearise
        });
    }

    /// Tries a shorter step.
    fn refuse(&mut self) {
        if self.ending == Ending::WorkingOut {
            // The system is not determined.
            self.ending = Ending::Refining;
            return self.enter(Phase::Done);
        }
        self.damping *= 10.0;
        self.enter(if self.steps >= self.config.steps { Phase::Judge } else { Phase::Eliminate });
    }

    fn judge(&mut self) -> usize {
        let (points, last) = self.chunk();
        for index in points.clone() {
            let point = self.here.points[index].into();
            for i in self.layout.of_point(index) {
                let seen = &self.layout.seen[i];
                let chi2 = self.lens.chi2(&self.here.views[seen.pose as usize], seen, &point);
                self.chi2[self.layout.order[i] as usize] = chi2;
            }
        }
        if last && self.config.covariances {
            (self.ending, self.damping) = (Ending::WorkingOut, COVARIANCE_DAMPING);
            self.enter(Phase::Linearise);
        } else if last {
            self.enter(Phase::Done);
        }
        self.observations(&points)
    }

    fn invert(&mut self) -> usize {
        match self.normal.reduced.invert_on() {
            Some(products) => WORK_PER_PRODUCT * products,
            None => {
                self.ending = Ending::WorkedOut;
                self.enter(Phase::Done);
                1
            }
        }
    }
}

impl State {
    /// Brings the views up to date with the poses.
    fn compute_views(&mut self, rows: &[u32]) {
        self.views.clear();
        self.views.extend(self.poses.iter().zip(rows).map(|(pose, row)| View::of(pose, *row)));
    }
}

impl BundleProblem {
    /// Refines the free poses and all points in one call with its own buffers.
    pub fn solve(&self, config: &BundleConfig) -> BundleSolution {
        let mut solver = BundleSolver::default();
        solver.begin(self, config);
        solver.finish();
        BundleSolution {
            poses: solver.poses().to_vec(),
            points: solver.points().to_vec(),
            chi2: solver.chi2().to_vec(),
            initial_cost: solver.initial_cost(),
            final_cost: solver.cost(),
            steps: solver.steps(),
        }
    }
}

/// Units of work for moving a number of poses.
fn reduced_work(poses: usize) -> usize {
    20 * poses + 1
}

/// The pairs of free poses that see a point in common or are tied, by node.
fn coupled(problem: &BundleProblem, nodes: &[u32], free: usize, pairs: &mut Vec<(usize, usize)>) {
    let mut seers: Vec<Vec<u32>> = vec![Vec::new(); problem.points.len()];
    for seen in problem.observations.iter().filter(|seen| nodes[seen.pose] != FIXED_ROW) {
        seers[seen.point].push(nodes[seen.pose]);
    }
    let mut is_coupled = vec![false; free * free];
    for seers in &mut seers {
        seers.sort_unstable();
        for (i, a) in seers.iter().enumerate() {
            seers[i + 1..].iter().for_each(|b| is_coupled[*a as usize * free + *b as usize] = true);
        }
    }
    for constraint in &problem.constraints {
        let (a, b) = (nodes[constraint.from], nodes[constraint.to]);
        if a != FIXED_ROW && b != FIXED_ROW {
            is_coupled[a.min(b) as usize * free + a.max(b) as usize] = true;
        }
    }
    pairs.clear();
    let coupled = is_coupled.iter().enumerate().filter(|(_, is)| **is);
    pairs.extend(coupled.map(|(i, _)| (i / free, i % free)).filter(|(a, b)| a < b));
}

//! Self-calibration: the camera settings that make matches of frame pairs agree best.

use nalgebra::{Matrix2, Matrix2x3, Matrix6, RowVector6, SMatrix, SVector, Vector6};
use trundle_core::{Pose3, Vector2, Vector3};

/// Errors of the settings to first order, in the order scale x, y, shift x, y, k1, k2. True normalised coordinates from the assumed ones n
/// are n (1 + scale) + shift + n (k1 |n|^2 + k2 |n|^4).
pub(crate) type CalibrationOffset = Vector6<f64>;

/// A match of two frames in normalised coordinates of the rectified image.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FeaturePair {
    pub a: Vector2,
    /// Depth along the optical axis, m.
    pub depth_a: f64,
    pub b: Vector2,
    /// Inverse depth and its standard deviation, 1/m.
    pub inverse_b: Option<(f64, f64)>,
    /// Standard deviation of `b`.
    pub sigma: f64,
    /// Rows of the feature in the two raw images, as fractions of the height from the middle row, -0.5 to 0.5.
    pub rows: (f64, f64),
}

/// Matches of two frames and the motion between.
#[derive(Debug, Clone)]
pub(crate) struct Pair {
    pub b_from_a: Pose3,
    pub matches: Vec<FeaturePair>,
}

/// Result of a fit.
#[derive(Debug, Clone)]
pub(crate) struct FittedOffset {
    pub offset: CalibrationOffset,
    /// Remaining robust cost.
    pub cost: f64,
    /// Standard deviations of the offset.
    pub sigmas: CalibrationOffset,
}

/// Maximum number of iterations of Gauss-Newton: 10. Source: ours.
const MAX_ITERATIONS: usize = 10;
/// Relative decrease of the cost below which the iteration ends: 1e-6. Source: ours.
const MIN_COST_DECREASE: f64 = 1e-6;
/// Scale of Cauchy's loss: 2.5 standard deviations. Larger residuals, of wrong matches, weigh little. Source: ours.
const CAUCHY_SIGMAS: f64 = 2.5;
/// Prior standard deviations of the offsets: wide, so that they only keep unobservable offsets at zero. Source: ours.
const PRIOR_SIGMAS: [f64; 6] = [0.3, 0.3, 0.1, 0.1, 0.5, 0.5];

/// The search for the offsets that make matches agree best, with free motions. Only the offsets marked in `free` are estimated; the others
/// keep their initial values. Method: least squares with Cauchy's loss on column, row and inverse depth, with motions eliminated (Schur
/// complement). Each call does one iteration over the same pairs.
#[derive(Debug, Clone)]
pub(crate) struct CalibrationFit {
    free: [bool; 6],
    offset: CalibrationOffset,
    motions: Vec<Pose3>,
    rounds: usize,
    cost: f64,
    /// Equations of the offsets from each pair, with its weights of the last round.
    parts: Vec<PairEquations>,
}

impl CalibrationFit {
    pub fn new(pairs: &[Pair], start: CalibrationOffset, free: [bool; 6]) -> Self {
        let motions = pairs.iter().map(|pair| pair.b_from_a).collect();
        Self { free, offset: start, motions, rounds: 0, cost: f64::INFINITY, parts: Vec::new() }
    }

    /// One round of Gauss-Newton. Returns whether it was the last.
    pub fn advance(&mut self, pairs: &[Pair]) -> bool {
        let parts: Vec<PairEquations> = pairs
            .iter()
            .zip(&self.motions)
            .map(|(pair, motion)| PairEquations::of(pair, motion, &self.offset))
            .collect();
        let cost = parts.iter().map(|part| part.cost).sum();
        let gain = self.cost - cost;
        (self.rounds, self.cost) = (self.rounds + 1, cost);
        let step = self.step(&parts, None).unwrap_or_else(|| CalibrationOffset::repeat(f64::NAN));
        for (motion, part) in self.motions.iter_mut().zip(&parts) {
            let tangent = part.motion(&step).unwrap_or_else(Vector6::zeros);
            *motion = (Pose3::exp(tangent) * *motion).renormalized();
        }
        self.offset += step;
        self.parts = parts;
        let is_lost = !self.offset.iter().all(|v| v.is_finite());
        is_lost || self.rounds >= MAX_ITERATIONS || gain.abs() <= MIN_COST_DECREASE * cost
    }

    /// The result, once the last round is done; `None` if the fit failed.
    pub fn result(&self) -> Option<FittedOffset> {
        let offset = self.offset;
        let sigmas = self.spread()?;
        offset.iter().all(|v| v.is_finite()).then_some(FittedOffset { offset, cost: self.cost, sigmas })
    }

    /// The step of the offsets by all pairs, or by all but the pair `without`.
    fn step(&self, parts: &[PairEquations], without: Option<usize>) -> Option<CalibrationOffset> {
        let prior = Vector6::from(PRIOR_SIGMAS).map(|sigma| sigma.powi(-2));
        let mut matrix = Matrix6::from_diagonal(&prior);
        let mut gradient = -prior.component_mul(&self.offset);
        for (_, part) in parts.iter().enumerate().filter(|(i, _)| Some(*i) != without) {
            matrix += part.reduced;
            gradient += part.reduced_gradient;
        }
        for i in (0..6).filter(|i| !self.free[*i]) {
            matrix.row_mut(i).fill(0.0);
            matrix.column_mut(i).fill(0.0);
            matrix[(i, i)] = 1e12;
            gradient[i] = 0.0;
        }
        Some(matrix.cholesky()?.solve(&gradient))
    }

    /// Standard deviations of the offsets by leaving out each pair in turn (jackknife: one step from the solution of all pairs). They
    /// include errors of a whole pair, such as a rolling shutter.
    fn spread(&self) -> Option<CalibrationOffset> {
        let all = self.step(&self.parts, None)?;
        let without = |i: usize| Some(self.step(&self.parts, Some(i))? - all);
        let moved: Vec<CalibrationOffset> = (0..self.parts.len()).map(without).collect::<Option<_>>()?;
        let n = moved.len().max(1) as f64;
        let mean = moved.iter().sum::<CalibrationOffset>() / n;
        let squares: CalibrationOffset = moved.iter().map(|o| (o - mean).map(|d| d * d)).sum();
        Some((squares * ((n - 1.0) / n)).map(f64::sqrt))
    }
}

/// True normalised coordinates from the assumed ones.
pub(crate) fn corrected(n: Vector2, offset: &CalibrationOffset) -> Vector2 {
    n.component_mul(&stretch(n, offset)) + Vector2::new(offset[2], offset[3])
}

/// The inverse of [`corrected`], with an error well below a pixel for plausible offsets.
fn uncorrected(m: Vector2, offset: &CalibrationOffset) -> Vector2 {
    let shifted = m - Vector2::new(offset[2], offset[3]);
    (0..5).fold(m, |n, _| shifted.component_div(&stretch(n, offset)))
}

/// Factors of the coordinates n in x and y.
fn stretch(n: Vector2, offset: &CalibrationOffset) -> Vector2 {
    let r2 = n.norm_squared();
    let radial = r2 * (offset[4] + r2 * offset[5]);
    Vector2::new(1.0 + offset[0] + radial, 1.0 + offset[1] + radial).map(|s| s.max(0.2))
}

/// Derivative of [`corrected`] with respect to the offsets.
pub(crate) fn by_offset(n: Vector2) -> SMatrix<f64, 2, 6> {
    let r2 = n.norm_squared();
    let row = |v: f64, x: f64, y: f64| [v * x, v * y, x, y, v * r2, v * r2 * r2];
    let rows = [row(n.x, 1.0, 0.0), row(n.y, 0.0, 1.0)];
    SMatrix::from_rows(&rows.map(RowVector6::from))
}

/// The normal equations of one pair: of its motion, and of the offsets after elimination of the motion.
#[derive(Debug, Clone)]
struct PairEquations {
    own: Matrix6<f64>,
    mixed: Matrix6<f64>,
    gradient: Vector6<f64>,
    reduced: Matrix6<f64>,
    reduced_gradient: Vector6<f64>,
    cost: f64,
}

impl PairEquations {
    fn of(pair: &Pair, b_from_a: &Pose3, offset: &CalibrationOffset) -> Self {
        let (zero, none) = (Matrix6::zeros(), Vector6::zeros());
        let mut part = Self {
            own: Matrix6::identity() * 1e-6,
            mixed: zero,
            gradient: none,
            reduced: zero,
            reduced_gradient: none,
            cost: 0.0,
        };
        for matched in &pair.matches {
            let Some(rows) = ResidualRows::of(matched, b_from_a, offset) else { continue };
            let (w, cost) = cauchy(rows.residual.norm_squared());
            let (j, m, r) = (&rows.by_offset, &rows.by_motion, &rows.residual);
            part.reduced += j.transpose() * j * w;
            part.reduced_gradient -= j.transpose() * r * w;
            part.own += m.transpose() * m * w;
            part.mixed += m.transpose() * j * w;
            part.gradient -= m.transpose() * r * w;
            part.cost += cost;
        }
        if let Some(factor) = part.own.cholesky() {
            part.reduced -= part.mixed.transpose() * factor.solve(&part.mixed);
            part.reduced_gradient -= part.mixed.transpose() * factor.solve(&part.gradient);
        }
        part
    }

    /// The change of the pair's motion with a step of the offsets.
    fn motion(&self, step: &CalibrationOffset) -> Option<Vector6<f64>> {
        Some(self.own.cholesky()?.solve(&(self.gradient - self.mixed * step)))
    }
}

/// Weight and cost of a squared residual.
pub(crate) fn cauchy(squared: f64) -> (f64, f64) {
    let bent = 1.0 + squared / (CAUCHY_SIGMAS * CAUCHY_SIGMAS);
    (1.0 / bent, CAUCHY_SIGMAS * CAUCHY_SIGMAS * bent.ln())
}

/// The residual of one match over its standard deviations, and its derivatives by offsets and motion.
#[derive(Debug)]
struct ResidualRows {
    residual: Vector3,
    by_offset: SMatrix<f64, 3, 6>,
    by_motion: SMatrix<f64, 3, 6>,
}

impl ResidualRows {
    fn of(matched: &FeaturePair, b_from_a: &Pose3, offset: &CalibrationOffset) -> Option<Self> {
        let FeaturePair { a, depth_a, b, inverse_b, sigma, .. } = *matched;
        let ray = corrected(a, offset);
        let p = b_from_a.transform(Vector3::new(ray.x, ray.y, 1.0) * depth_a);
        if p.z <= 0.05 {
            return None;
        }
        // Residuals are in the assumed coordinates: in the true ones, a fit could shrink the image to reduce the errors.
        let expected = uncorrected(Vector2::new(p.x, p.y) / p.z, offset);
        let unstretched = Matrix2::from_diagonal(&stretch(expected, offset).map(f64::recip));
        let projection =
            unstretched * Matrix2x3::new(1.0, 0.0, -p.x / p.z, 0.0, 1.0, -p.y / p.z) / (p.z * sigma);
        let rotation = b_from_a.rotation_matrix();
        let point_by_offset = rotation.fixed_columns::<2>(0) * by_offset(a) * depth_a;
        let mut point_by_motion = SMatrix::<f64, 3, 6>::zeros();
        point_by_motion.fixed_columns_mut::<3>(0).fill_with_identity();
        point_by_motion.fixed_columns_mut::<3>(3).copy_from(&-p.cross_matrix());
        let mut by = SMatrix::<f64, 3, 6>::zeros();
        let mut by_motion = SMatrix::<f64, 3, 6>::zeros();
        by.fixed_rows_mut::<2>(0)
            .copy_from(&(projection * point_by_offset - unstretched * by_offset(expected) / sigma));
        by_motion.fixed_rows_mut::<2>(0).copy_from(&(projection * point_by_motion));
        let off = (expected - b) / sigma;
        let mut third = 0.0;
        if let Some((inverse, sigma)) = inverse_b {
            let by_z: SVector<f64, 1> = SVector::from([-1.0 / (p.z * p.z * sigma)]);
            by.fixed_rows_mut::<1>(2).copy_from(&(by_z * point_by_offset.row(2)));
            by_motion.fixed_rows_mut::<1>(2).copy_from(&(by_z * point_by_motion.row(2)));
            third = (1.0 / p.z - inverse) / sigma;
        }
        Some(Self { residual: Vector3::new(off.x, off.y, third), by_offset: by, by_motion })
    }
}

use nalgebra::{Matrix2, Matrix2x3, Matrix6, RowVector6, SMatrix, SVector, Vector6};
use trundle_core::{Pose3, Vector2, Vector3};

/// What the settings may be off by, to first order: true normalised coordinates from the assumed ones n are
/// n (1 + scale) + shift + n (k1 |n|^2 + k2 |n|^4), the numbers in the order scale x, y, shift x, y, k1, k2.
pub(super) type Offset = Vector6<f64>;

/// A match of two frames in normalised coordinates of the rectified image.
#[derive(Debug, Clone, Copy)]
pub(super) struct Matched {
    pub a: Vector2,
    /// Along the optical axis, m.
    pub depth_a: f64,
    pub b: Vector2,
    /// Inverse depth and its standard deviation, 1/m.
    pub inverse_b: Option<(f64, f64)>,
    /// Standard deviation of `b`.
    pub sigma: f64,
}

/// Matches of two frames and the motion between.
#[derive(Debug, Clone)]
pub(super) struct Pair {
    pub b_from_a: Pose3,
    pub matches: Vec<Matched>,
}

/// What a fit found.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fitted {
    pub offset: Offset,
    /// Robust cost that is left.
    pub cost: f64,
}

/// Rounds of Gauss-Newton.
const ROUNDS: usize = 10;
/// Where Cauchy's loss bends, standard deviations: wrong matches are among the others.
const CAUCHY: f64 = 2.5;
/// Standard deviations of the offsets before anything is seen: wide, they only keep what is not seen at zero.
const PRIOR: [f64; 6] = [0.3, 0.3, 0.1, 0.1, 0.5, 0.5];

/// The offsets that make matches agree best, the motions being free. Only those marked in `free` are looked for; the others
/// stay as in `start`. Least
/// squares with Cauchy's loss on column, row and inverse depth, the motions eliminated (Schur complement).
pub(super) fn fit(pairs: &[Pair], start: Offset, free: [bool; 6]) -> Option<Fitted> {
    let mut pairs = pairs.to_vec();
    let mut offset = start;
    let mut last = None;
    for _ in 0..ROUNDS {
        let system = System::of(&pairs, &offset, free);
        let step = system.reduced.cholesky()?.solve(&system.gradient);
        for (pair, motion) in pairs.iter_mut().zip(&system.motions) {
            let tangent = motion.solve(&step)?;
            pair.b_from_a = (Pose3::exp(tangent) * pair.b_from_a).renormalized();
        }
        offset += step;
        last = Some(Fitted { offset, cost: system.cost });
    }
    last.filter(|fitted| fitted.offset.iter().all(|v| v.is_finite()))
}

/// True normalised coordinates from the assumed ones.
pub(super) fn corrected(n: Vector2, offset: &Offset) -> Vector2 {
    n.component_mul(&stretch(n, offset)) + Vector2::new(offset[2], offset[3])
}

/// The inverse of [`corrected`], to well below a pixel for offsets that a fit may find.
fn uncorrected(m: Vector2, offset: &Offset) -> Vector2 {
    let shifted = m - Vector2::new(offset[2], offset[3]);
    (0..5).fold(m, |n, _| shifted.component_div(&stretch(n, offset)))
}

/// What coordinates n are multiplied by in x and y.
fn stretch(n: Vector2, offset: &Offset) -> Vector2 {
    let r2 = n.norm_squared();
    let radial = r2 * (offset[4] + r2 * offset[5]);
    Vector2::new(1.0 + offset[0] + radial, 1.0 + offset[1] + radial).map(|s| s.max(0.2))
}

/// How [`corrected`] depends on the offsets.
pub(super) fn by_offset(n: Vector2) -> SMatrix<f64, 2, 6> {
    let r2 = n.norm_squared();
    let row = |v: f64, x: f64, y: f64| [v * x, v * y, x, y, v * r2, v * r2 * r2];
    let rows = [row(n.x, 1.0, 0.0), row(n.y, 0.0, 1.0)];
    SMatrix::from_rows(&rows.map(RowVector6::from))
}

/// The normal equations of one round.
#[derive(Debug)]
struct System {
    reduced: Matrix6<f64>,
    gradient: Vector6<f64>,
    motions: Vec<Motion>,
    cost: f64,
}

/// What gives a pair's motion once the offsets are known.
#[derive(Debug)]
struct Motion {
    own: Matrix6<f64>,
    mixed: Matrix6<f64>,
    gradient: Vector6<f64>,
}

impl Motion {
    fn solve(&self, step: &Vector6<f64>) -> Option<Vector6<f64>> {
        Some(self.own.cholesky()?.solve(&(self.gradient - self.mixed * step)))
    }
}

impl System {
    fn of(pairs: &[Pair], offset: &Offset, free: [bool; 6]) -> Self {
        let prior = Vector6::from(PRIOR).map(|sigma| sigma.powi(-2));
        let mut reduced = Matrix6::from_diagonal(&prior);
        let mut gradient = -prior.component_mul(offset);
        let mut system = Self { reduced, gradient, motions: Vec::with_capacity(pairs.len()), cost: 0.0 };
        for pair in pairs {
            let mut motion = Motion {
                own: Matrix6::identity() * 1e-6,
                mixed: Matrix6::zeros(),
                gradient: Vector6::zeros(),
            };
            for matched in &pair.matches {
                let Some(rows) = Rows::of(matched, &pair.b_from_a, offset) else { continue };
                let (w, cost) = cauchy(rows.residual.norm_squared());
                let (j, m, r) = (&rows.by_offset, &rows.by_motion, &rows.residual);
                reduced += j.transpose() * j * w;
                gradient -= j.transpose() * r * w;
                motion.own += m.transpose() * m * w;
                motion.mixed += m.transpose() * j * w;
                motion.gradient -= m.transpose() * r * w;
                system.cost += cost;
            }
            if let Some(factor) = motion.own.cholesky() {
                reduced -= motion.mixed.transpose() * factor.solve(&motion.mixed);
                gradient -= motion.mixed.transpose() * factor.solve(&motion.gradient);
            }
            system.motions.push(motion);
        }
        for i in (0..6).filter(|i| !free[*i]) {
            reduced.row_mut(i).fill(0.0);
            reduced.column_mut(i).fill(0.0);
            reduced[(i, i)] = 1e12;
            gradient[i] = 0.0;
        }
        (system.reduced, system.gradient) = (reduced, gradient);
        system
    }
}

/// Weight and cost of a squared residual.
fn cauchy(squared: f64) -> (f64, f64) {
    let bent = 1.0 + squared / (CAUCHY * CAUCHY);
    (1.0 / bent, CAUCHY * CAUCHY * bent.ln())
}

/// The residual of one match over its standard deviations, and how it depends on offsets and motion.
#[derive(Debug)]
struct Rows {
    residual: Vector3,
    by_offset: SMatrix<f64, 3, 6>,
    by_motion: SMatrix<f64, 3, 6>,
}

impl Rows {
    fn of(matched: &Matched, b_from_a: &Pose3, offset: &Offset) -> Option<Self> {
        let Matched { a, depth_a, b, inverse_b, sigma } = *matched;
        let ray = corrected(a, offset);
        let p = b_from_a.transform(Vector3::new(ray.x, ray.y, 1.0) * depth_a);
        if p.z <= 0.05 {
            return None;
        }
        // Compared where it was measured, in the assumed coordinates: else a fit could shrink the picture to shrink the errors.
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

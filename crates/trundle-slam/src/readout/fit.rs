//! The readout time that makes the matches of image pairs agree best: Gauss-Newton with motions eliminated.

use crate::calibration_check::self_calibration::{FeaturePair, Pair, cauchy};
use nalgebra::{Matrix2x3, Matrix6, RowVector3, SMatrix, Vector6};
use trundle_core::{Pose3, Vector2, Vector3};

/// Fewest image pairs of an estimate: 12. Fewer do not show their scatter. Source: ours.
const MIN_PAIRS: usize = 12;
/// Maximum number of iterations: 10. Source: ours.
const MAX_ITERATIONS: usize = 10;
/// Step of the readout time that ends the iteration: 1e-6 s. Source: ours.
const MIN_STEP_S: f64 = 1e-6;
/// Standard deviation of the prior around 0: 0.05 s, the longest readout time of a camera. Source: ours.
const PRIOR_SIGMA_S: f64 = 0.05;
/// Smallest readout time in standard deviations that shows a rolling shutter: 4. Source: ours.
const MIN_SIGMAS: f64 = 4.0;
/// Largest standard deviation of a readout time that is used: 5 ms. On freiburg1_rpy all times within 10 ms of the true one are better than
/// none. Source: docs/experiments/slam-rolling-shutter.md.
const MAX_SIGMA_S: f64 = 0.005;
/// Smallest readout time that is used: 3 ms. A shorter one moves points by less than a pixel at 1 rad/s. Source: ours.
const MIN_READOUT_S: f64 = 0.003;

/// Two images of a turning camera: matches, and turn rates in the camera frame, rad/s.
#[derive(Debug, Clone)]
pub(super) struct TurningPair {
    pub pair: Pair,
    pub rates: (Vector3, Vector3),
}

/// A readout time and its standard deviation, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReadoutEstimate {
    /// Time from the first to the last row, s. Negative for a camera that reads from the last row.
    pub readout_s: f64,
    /// Standard deviation, s, by leaving out each pair in turn.
    pub sigma_s: f64,
    /// Number of image pairs.
    pub pairs: usize,
}

impl ReadoutEstimate {
    /// Whether the images show a rolling shutter: the time is at least 3 ms and four standard deviations, which are at most 5 ms.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        let is_accurate = self.sigma_s <= MAX_SIGMA_S;
        is_accurate && self.readout_s >= MIN_READOUT_S && self.readout_s >= MIN_SIGMAS * self.sigma_s
    }
}

/// The estimate by all pairs; `None` with too few pairs, or if it does not converge.
pub(super) fn fit(pairs: &[TurningPair]) -> Option<ReadoutEstimate> {
    if pairs.len() < MIN_PAIRS {
        return None;
    }
    let mut motions: Vec<Pose3> = pairs.iter().map(|turning| turning.pair.b_from_a).collect();
    let mut readout = 0.0;
    let mut parts = Vec::new();
    for _ in 0..MAX_ITERATIONS {
        let equations = |(turning, motion)| Equations::of(turning, motion, readout);
        parts = pairs.iter().zip(&motions).map(equations).collect();
        let step = step(parts.iter(), readout);
        for (motion, part) in motions.iter_mut().zip(&parts) {
            let tangent = part.motion(step).unwrap_or_else(Vector6::zeros);
            *motion = (Pose3::exp(tangent) * *motion).renormalized();
        }
        readout += step;
        if step.abs() < MIN_STEP_S {
            break;
        }
    }
    let sigma_s = spread(&parts, readout);
    let is_valid = readout.is_finite() && sigma_s.is_finite() && readout.abs() <= PRIOR_SIGMA_S;
    is_valid.then_some(ReadoutEstimate { readout_s: readout, sigma_s, pairs: pairs.len() })
}

/// The step of the readout time by these equations and the prior.
fn step<'a>(parts: impl Iterator<Item = &'a Equations>, readout: f64) -> f64 {
    let prior = PRIOR_SIGMA_S.powi(-2);
    let (matrix, gradient) = parts.fold((prior, -prior * readout), |(matrix, gradient), part| {
        (matrix + part.reduced, gradient + part.reduced_gradient)
    });
    gradient / matrix
}

/// Standard deviation by leaving out each pair in turn (jackknife: one step from the solution of all pairs).
fn spread(parts: &[Equations], readout: f64) -> f64 {
    let all = step(parts.iter(), readout);
    let without = |i: usize| {
        let others = parts.iter().enumerate().filter(|(other, _)| *other != i).map(|(_, part)| part);
        step(others, readout) - all
    };
    let moved: Vec<f64> = (0..parts.len()).map(without).collect();
    let n = moved.len().max(1) as f64;
    let mean = moved.iter().sum::<f64>() / n;
    (moved.iter().map(|step| (step - mean).powi(2)).sum::<f64>() * (n - 1.0) / n).sqrt()
}

/// The normal equations of one pair: of its motion, and of the readout time after elimination of the motion.
struct Equations {
    own: Matrix6<f64>,
    mixed: Vector6<f64>,
    gradient: Vector6<f64>,
    reduced: f64,
    reduced_gradient: f64,
}

impl Equations {
    fn of(turning: &TurningPair, b_from_a: &Pose3, readout: f64) -> Self {
        let mut sums = Self {
            own: Matrix6::identity() * 1e-6,
            mixed: Vector6::zeros(),
            gradient: Vector6::zeros(),
            reduced: 0.0,
            reduced_gradient: 0.0,
        };
        for matched in &turning.pair.matches {
            let Some(rows) = Rows::of(matched, b_from_a, turning.rates, readout) else { continue };
            let (weight, _) = cauchy(rows.residual.norm_squared());
            let Rows { residual, by_readout, by_motion } = rows;
            sums.own += by_motion.transpose() * by_motion * weight;
            sums.mixed += by_motion.transpose() * by_readout * weight;
            sums.gradient -= by_motion.transpose() * residual * weight;
            sums.reduced += by_readout.norm_squared() * weight;
            sums.reduced_gradient -= by_readout.dot(&residual) * weight;
        }
        if let Some(factor) = sums.own.cholesky() {
            sums.reduced -= sums.mixed.dot(&factor.solve(&sums.mixed));
            sums.reduced_gradient -= sums.mixed.dot(&factor.solve(&sums.gradient));
        }
        sums
    }

    /// The change of the pair's motion with a step of the readout time.
    fn motion(&self, step: f64) -> Option<Vector6<f64>> {
        Some(self.own.cholesky()?.solve(&(self.gradient - self.mixed * step)))
    }
}

/// The residual of one match over its standard deviations, and its derivatives.
struct Rows {
    residual: Vector3,
    by_readout: Vector3,
    by_motion: SMatrix<f64, 3, 6>,
}

impl Rows {
    /// `None` for a point at or behind the camera. Turns during the readout are small, and taken to first order.
    fn of(matched: &FeaturePair, b_from_a: &Pose3, rates: (Vector3, Vector3), readout: f64) -> Option<Self> {
        let FeaturePair { a, depth_a, b, inverse_b, sigma, rows } = *matched;
        let seen = Vector3::new(a.x, a.y, 1.0) * depth_a;
        let turn_a = rates.0.cross(&seen) * rows.0;
        let middle = b_from_a.transform(seen + turn_a * readout);
        let turn_b = -rates.1.cross(&middle) * rows.1;
        let p = middle + turn_b * readout;
        if p.z <= 0.05 {
            return None;
        }
        let mut projection = SMatrix::<f64, 3, 3>::zeros();
        let image = Matrix2x3::new(1.0, 0.0, -p.x / p.z, 0.0, 1.0, -p.y / p.z) / (p.z * sigma);
        projection.fixed_rows_mut::<2>(0).copy_from(&image);
        let off = (Vector2::new(p.x, p.y) / p.z - b) / sigma;
        let mut third = 0.0;
        if let Some((inverse, sigma)) = inverse_b {
            projection.set_row(2, &RowVector3::new(0.0, 0.0, -1.0 / (p.z * p.z * sigma)));
            third = (1.0 / p.z - inverse) / sigma;
        }
        let by_readout = projection * (b_from_a.rotate(turn_a) + turn_b);
        let mut point_by_motion = SMatrix::<f64, 3, 6>::zeros();
        point_by_motion.fixed_columns_mut::<3>(0).fill_with_identity();
        point_by_motion.fixed_columns_mut::<3>(3).copy_from(&-p.cross_matrix());
        let residual = Vector3::new(off.x, off.y, third);
        Some(Self { residual, by_readout, by_motion: projection * point_by_motion })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;

    /// Numbers from -1 to 1 (Knuth's linear congruential generator).
    struct Noise(u64);

    impl Noise {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        }
    }

    /// A pair of images of random points, taken with this readout time; pixels have a noise of 1 px at 500 px focal length.
    fn turning_pair(readout: f64, rates: (Vector3, Vector3), noise: &mut Noise) -> TurningPair {
        let turn = UnitQuaternion::from_scaled_axis((rates.0 + rates.1) * -0.08);
        let b_from_a = Pose3::new(turn, Vector3::new(0.01, -0.02, 0.015));
        let mut noise = || 1.7 * noise.next() / 500.0;
        let rows = |y: f64| (y / 0.9).clamp(-0.5, 0.5);
        let matches = (0..120).map(|i| {
            let (column, row) = (i % 12, i / 12);
            let ray = Vector3::new(f64::from(column) / 12.0 - 0.5, f64::from(row) / 11.0 - 0.45, 1.0);
            let depth_a = 1.0 + f64::from((i * 7) % 30) / 10.0;
            let seen = ray * depth_a;
            let row_a = rows(ray.y);
            let middle =
                b_from_a.transform(UnitQuaternion::from_scaled_axis(rates.0 * readout * row_a) * seen);
            // The row of the point in b depends on the turn by itself.
            let mut p = middle;
            for _ in 0..5 {
                p = UnitQuaternion::from_scaled_axis(rates.1 * -readout * rows(p.y / p.z)) * middle;
            }
            FeaturePair {
                a: Vector2::new(ray.x, ray.y),
                depth_a,
                b: Vector2::new(p.x / p.z + noise(), p.y / p.z + noise()),
                inverse_b: Some((1.0 / p.z, 0.004)),
                sigma: 1.0 / 500.0,
                rows: (row_a, rows(p.y / p.z)),
            }
        });
        let matches = matches.collect();
        TurningPair { pair: Pair { b_from_a, matches }, rates }
    }

    fn pairs(readout: f64, speed: f64) -> Vec<TurningPair> {
        let mut noise = Noise(7);
        let mut pairs = Vec::new();
        for _ in 0..30 {
            let mut rate = || Vector3::from_fn(|_, _| speed * noise.next());
            let rates = (rate(), rate());
            pairs.push(turning_pair(readout, rates, &mut noise));
        }
        pairs
    }

    #[test]
    fn the_readout_time_of_a_turning_camera_is_found() {
        for truth in [0.0, 0.01, 0.026, 0.033] {
            let found = fit(&pairs(truth, 0.8)).unwrap();
            let error = (found.readout_s - truth).abs();
            assert!(error < 0.0015 && error < 4.0 * found.sigma_s, "{truth}: {found:?}");
            assert_eq!(found.is_clear(), truth > 0.0, "{truth}: {found:?}");
        }
    }

    #[test]
    fn a_camera_that_does_not_turn_has_no_clear_readout_time() {
        let found = fit(&pairs(0.026, 0.01)).unwrap();
        assert!(!found.is_clear(), "{found:?}");
        assert_eq!(fit(&pairs(0.026, 0.8)[..MIN_PAIRS - 1]), None, "too few pairs");
    }
}

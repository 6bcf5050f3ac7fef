//! Weights that limit the influence of single points on a pose.

use nalgebra::{Matrix3x6, Matrix6};

/// Largest share of a point in one of the six components of a pose, with enough points: 0.25. A point with a larger share, a near one among
/// many far ones, would alone determine the pose, right or wrong. Source: ours, after \[Hampel86\].
const MAX_LEVERAGE: f64 = 0.25;
/// Largest share in multiples of the mean share, with few points: 3. Source: ours.
const MAX_LEVERAGE_OF_MEAN: f64 = 3.0;
/// Largest number of passes over the points: 20. Three wrong points that agree are bounded after some ten. Source: ours.
const MAX_PASSES: usize = 20;
/// Ratio of a share to its limit that ends the passes: 1.1. Source: ours.
const LEVERAGE_TOLERANCE: f64 = 1.1;

/// Weight of each of `rows`, 0 to 1, with which no leverage exceeds the bound (the GM-estimators of Mallows, \[Hampel86\]). The rows are
/// the Jacobians of points' residuals in standard deviations; leverage is the part of the fit determined by one point.
pub(crate) fn bounded(rows: &[Matrix3x6<f64>]) -> Vec<f64> {
    let mut weights = vec![1.0; rows.len()];
    let counted = rows.iter().filter(|row| **row != Matrix3x6::zeros()).count();
    let max = MAX_LEVERAGE.max(MAX_LEVERAGE_OF_MEAN * 6.0 / counted.max(1) as f64);
    for _ in 0..MAX_PASSES {
        let information = sum(rows, &weights);
        let Some(covariance) = information.cholesky().map(|c| c.inverse()) else { break };
        let mut is_bounded = true;
        for (row, weight) in rows.iter().zip(&mut weights) {
            let leverage = *weight * (row * covariance).component_mul(row).sum();
            if leverage > max * LEVERAGE_TOLERANCE {
                *weight *= max / leverage;
                is_bounded = false;
            }
        }
        if is_bounded {
            break;
        }
    }
    weights
}

fn sum(rows: &[Matrix3x6<f64>], weights: &[f64]) -> Matrix6<f64> {
    rows.iter().zip(weights).map(|(row, weight)| row.transpose() * row * *weight).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows that measure each part of a pose `times` times.
    fn rows(times: usize) -> Vec<Matrix3x6<f64>> {
        let row = |i: usize| Matrix3x6::from_fn(|r, c| f64::from(u8::from((2 * i + r) % 6 == c)));
        (0..times * 3).map(row).collect()
    }

    #[test]
    fn points_confirmed_by_others_have_full_weight() {
        assert_eq!(bounded(&rows(10)), vec![1.0; 30]);
        assert_eq!(bounded(&[]), Vec::<f64>::new());
        assert_eq!(
            bounded(&rows(1)[..1]),
            vec![1.0],
            "points without information about a pose have full weight"
        );
    }

    #[test]
    fn a_point_that_decides_alone_is_weighted_down() {
        let mut rows = rows(20);
        rows[7] *= 1000.0;
        let weights = bounded(&rows);
        let covariance = sum(&rows, &weights).try_inverse().unwrap();
        let leverage = weights[7] * (rows[7] * covariance).component_mul(&rows[7]).sum();
        assert!(
            weights[7] < 1e-4 && (0.2..=MAX_LEVERAGE_OF_MEAN * 0.1 * LEVERAGE_TOLERANCE).contains(&leverage),
            "{leverage}"
        );
        assert!(weights.iter().enumerate().all(|(i, weight)| i == 7 || *weight == 1.0));
    }
}

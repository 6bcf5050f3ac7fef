use nalgebra::{Matrix3x6, Matrix6};

/// No point makes up more of a pose than this, of the six parts that a pose has, while there are enough of them. Points that
/// nobody could contradict, a near one among many far away, say, would put the camera wherever they were matched.
const MOST: f64 = 0.25;
/// With few points each makes up more: at most so many times the mean.
const MOST_OF_MEAN: f64 = 3.0;
/// Passes over the points; three that agree by chance are where they should be after some ten.
const PASSES: usize = 20;
/// A share this much above the most is good enough.
const SLACK: f64 = 1.1;

/// By how much to weight each of `rows`, the Jacobians of points' residuals in standard deviations, 0 to 1: so that no leverage,
/// the part of the fit that a point decides by itself, is above the bound (the GM-estimators of Mallows, \[Hampel86\]).
pub(crate) fn bounded(rows: &[Matrix3x6<f64>]) -> Vec<f64> {
    let mut weights = vec![1.0; rows.len()];
    let counted = rows.iter().filter(|row| **row != Matrix3x6::zeros()).count();
    let most = MOST.max(MOST_OF_MEAN * 6.0 / counted.max(1) as f64);
    for _ in 0..PASSES {
        let information = sum(rows, &weights);
        let Some(covariance) = information.cholesky().map(|c| c.inverse()) else { break };
        let mut is_bounded = true;
        for (row, weight) in rows.iter().zip(&mut weights) {
            let leverage = *weight * (row * covariance).component_mul(row).sum();
            if leverage > most * SLACK {
                *weight *= most / leverage;
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

    /// Rows that tell each part of a pose `times` times.
    fn rows(times: usize) -> Vec<Matrix3x6<f64>> {
        let row = |i: usize| Matrix3x6::from_fn(|r, c| f64::from(u8::from((2 * i + r) % 6 == c)));
        (0..times * 3).map(row).collect()
    }

    #[test]
    fn what_others_tell_as_well_counts_in_full() {
        assert_eq!(bounded(&rows(10)), vec![1.0; 30]);
        assert_eq!(bounded(&[]), Vec::<f64>::new());
        assert_eq!(bounded(&rows(1)[..1]), vec![1.0], "of what tells no pose nothing is asked");
    }

    #[test]
    fn what_decides_by_itself_is_held_down() {
        let mut rows = rows(20);
        rows[7] *= 1000.0;
        let weights = bounded(&rows);
        let covariance = sum(&rows, &weights).try_inverse().unwrap();
        let leverage = weights[7] * (rows[7] * covariance).component_mul(&rows[7]).sum();
        assert!(weights[7] < 1e-4 && (0.2..=MOST_OF_MEAN * 0.1 * SLACK).contains(&leverage), "{leverage}");
        assert!(weights.iter().enumerate().all(|(i, weight)| i == 7 || *weight == 1.0));
    }
}

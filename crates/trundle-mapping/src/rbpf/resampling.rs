//! Low-variance resampling and the effective number of particles.

/// Parents of the resampled particles: particle i becomes a copy of `parents[i]`. `uniform` in [0, 1).
///
/// Low-variance resampling (\[Thrun05\], table 4.4): one random number, equal strides through the weights. Survivors keep their indices, so
/// that only dropped particles are overwritten.
pub(crate) fn low_variance(weights: &[f64], uniform: f64) -> Vec<u16> {
    let count = weights.len();
    let total: f64 = weights.iter().sum();
    let mut copies = vec![0_usize; count];
    let (mut i, mut reached) = (0, weights[0]);
    for k in 0..count {
        let mark = (k as f64 + uniform) / count as f64 * total;
        while reached < mark && i + 1 < count {
            i += 1;
            reached += weights[i];
        }
        copies[i] += 1;
    }
    let mut parents: Vec<u16> = (0..count as u16).collect();
    let spare = (0..count).filter(|&i| copies[i] == 0).collect::<Vec<_>>();
    let extra = (0..count).flat_map(|i| std::iter::repeat_n(i, copies[i].saturating_sub(1)));
    for (place, parent) in spare.into_iter().zip(extra) {
        parents[place] = parent as u16;
    }
    parents
}

/// N_eff = 1 / sum of the squared normalised weights (\[Grisetti07\], eq. 20).
pub(crate) fn effective(weights: &[f64]) -> f64 {
    let total: f64 = weights.iter().sum();
    let squares: f64 = weights.iter().map(|w| (w / total).powi(2)).sum();
    1.0 / squares
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn everyone_gets_their_share(weights in prop::collection::vec(0.01..1.0_f64, 1..60), uniform in 0.0..1.0_f64) {
            let parents = low_variance(&weights, uniform);
            let total: f64 = weights.iter().sum();
            for (i, w) in weights.iter().enumerate() {
                let copies = parents.iter().filter(|&&p| usize::from(p) == i).count() as f64;
                let share = w / total * weights.len() as f64;
                prop_assert!((copies - share).abs() < 1.0 + 1e-9, "{} copies of {}", copies, share);
                if copies > 0.0 {
                    prop_assert_eq!(usize::from(parents[i]), i);
                }
            }
        }
    }

    #[test]
    fn equal_weights_are_all_effective() {
        assert!((effective(&[0.25; 4]) - 4.0).abs() < 1e-12);
        assert!((effective(&[1.0, 0.0, 0.0]) - 1.0).abs() < 1e-12);
    }
}

//! Association of two trajectories by time stamp.

use crate::{EvalError, Side};
use trundle_core::{Stamp, require_finite};

/// Pairs (index in `reference`, index in `estimate`) of poses that belong together, by rising time.
///
/// evo's rule: every stamp of the shorter list (the estimate for equal lengths) is associated with the nearest stamp of the longer list
/// within `max_difference` seconds. A stamp of the longer list may be taken twice. Of two equally near stamps the first is used. Equality
/// is decided in f64 seconds as in evo (0.2 us for present dates), because real files contain such ties.
///
/// # Errors
/// When a list is empty or its stamps decrease (TUM's ground truth repeats some), no stamp is near enough, or `max_difference` is not
/// finite.
pub fn associate(
    reference: &[Stamp],
    estimate: &[Stamp],
    max_difference: f64,
) -> Result<Vec<(usize, usize)>, EvalError> {
    require_finite("max_difference", max_difference, "s")?;
    let reference_span = span(reference, Side::Reference)?;
    let estimate_span = span(estimate, Side::Estimate)?;
    let (r, e): (Vec<f64>, Vec<f64>) =
        (reference.iter().map(seconds).collect(), estimate.iter().map(seconds).collect());
    let pairs: Vec<_> = if e.len() > r.len() {
        nearest(&r, &e, max_difference).collect()
    } else {
        nearest(&e, &r, max_difference).map(|(short, long)| (long, short)).collect()
    };
    if pairs.is_empty() {
        return Err(EvalError::NoAssociation {
            reference: reference_span,
            estimate: estimate_span,
            max_difference,
        });
    }
    Ok(pairs)
}

fn span(stamps: &[Stamp], side: Side) -> Result<(Stamp, Stamp), EvalError> {
    let (Some(&first), Some(&last)) = (stamps.first(), stamps.last()) else {
        return Err(EvalError::Empty(side));
    };
    match stamps.windows(2).position(|pair| pair[1] < pair[0]) {
        Some(i) => {
            Err(EvalError::StampsGoBack { side, index: i + 1, stamp: stamps[i + 1], before: stamps[i] })
        }
        None => Ok((first, last)),
    }
}

/// The f64 nearest to the stamp in seconds, equal to the parsed decimal text. (Whole seconds are exact, and no decimal of nine digits lies
/// near enough to the middle of two f64 for the second rounding to matter.)
fn seconds(stamp: &Stamp) -> f64 {
    (stamp.nanos / 1_000_000_000) as f64 + (stamp.nanos % 1_000_000_000) as f64 / 1e9
}

/// For every time of `short`, the nearest of `long` within `limit` s. Both lists are sorted.
fn nearest<'a>(short: &'a [f64], long: &'a [f64], limit: f64) -> impl Iterator<Item = (usize, usize)> + 'a {
    short.iter().enumerate().filter_map(move |(i, &time)| {
        let away = |j: usize| (long[j] - time).abs();
        let after = long.partition_point(|&t| t < time);
        let (before, after) = (after.saturating_sub(1), after.min(long.len() - 1));
        let near = if away(before) <= away(after) { before } else { after };
        let j = long.partition_point(|&t| t < long[near]); // the first of equal times
        (away(j) <= limit).then_some((i, j))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn stamps(millis: &[i64]) -> Vec<Stamp> {
        millis.iter().map(|ms| Stamp::from_nanos(ms * 1_000_000)).collect()
    }

    #[test]
    fn the_shorter_list_takes_the_nearest_of_the_longer() {
        let (truth, estimate) = (stamps(&[0, 10, 20, 30, 40]), stamps(&[9, 26, 55]));
        assert_eq!(associate(&truth, &estimate, 0.01), Ok(vec![(1, 0), (3, 1)]));
        assert_eq!(associate(&estimate, &truth, 0.01), Ok(vec![(0, 1), (1, 3)]));
        assert_eq!(associate(&stamps(&[10]), &stamps(&[20]), 0.01), Ok(vec![(0, 0)]));
        assert_eq!(associate(&stamps(&[0, 10]), &stamps(&[5]), 0.01), Ok(vec![(0, 0)]));
        assert_eq!(associate(&stamps(&[0, 3, 3, 3]), &stamps(&[4]), 0.01), Ok(vec![(1, 0)]));
    }

    #[test]
    fn says_what_is_wrong_with_numbers() {
        let sentence =
            |r: &[i64], e: &[i64], d| associate(&stamps(r), &stamps(e), d).unwrap_err().to_string();
        assert_eq!(
            sentence(&[0, 1000], &[5000, 6000], 0.02),
            "no pose of the estimate (5.000000000 s to 6.000000000 s) lies within 0.02 s of a pose of the \
             reference (0.000000000 s to 1.000000000 s)"
        );
        assert_eq!(sentence(&[], &[1], 0.02), "the reference trajectory has no pose");
        assert_eq!(
            sentence(&[1], &[1, 3, 2], 0.02),
            "stamp of estimate pose 2 is 0.002000000 s, expected at least the 0.003000000 s of the pose before"
        );
        assert!(sentence(&[1], &[1], f64::NAN).starts_with("max_difference is NaN s"));
        assert!(associate(&stamps(&[1]), &stamps(&[1]), -1.0).is_err());
    }

    #[test]
    fn seconds_are_those_of_the_decimal_text() {
        for nanos in
            [1_311_868_226_310_950_000, 1_305_031_229_528_748_001, -1, 5, 999_999_999, -1_500_000_000]
        {
            let stamp = Stamp::from_nanos(nanos);
            assert_eq!(seconds(&stamp), stamp.to_string().parse::<f64>().unwrap(), "{stamp}");
        }
    }

    proptest! {
        #[test]
        fn agrees_with_looking_at_every_pair(
            mut a in prop::collection::vec(0i64..400, 1..40),
            mut b in prop::collection::vec(0i64..400, 1..40),
        ) {
            a.sort();
            b.sort();
            let slow = |short: &[i64], long: &[i64]| -> Vec<(usize, usize)> {
                let nearest = |(i, s): (usize, &i64)| {
                    let away = |j: &usize| (seconds(&stamps(&[long[*j]])[0]) - seconds(&stamps(&[*s])[0])).abs();
                    let j = (0..long.len()).min_by(|j, k| away(j).total_cmp(&away(k)))?;
                    (away(&j) <= 0.01).then_some((i, j))
                };
                short.iter().enumerate().filter_map(nearest).collect()
            };
            let expected = if b.len() > a.len() {
                slow(&a, &b)
            } else {
                slow(&b, &a).into_iter().map(|(i, j)| (j, i)).collect()
            };
            prop_assert_eq!(associate(&stamps(&a), &stamps(&b), 0.01).unwrap_or_default(), expected);
        }
    }
}

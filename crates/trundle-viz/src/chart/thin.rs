//! Reduction of a long series to the points that a chart can show, with its peaks.

/// More points than this in a series are thinned. Source: ours.
const MAX_SERIES_POINTS: usize = 1500;

/// A series reduced to few points. If the series is long and its x increases, each of many columns retains its lowest and its highest
/// point, so no peak is lost. Gaps (points that are not finite) end a piece.
pub(crate) fn pieces(points: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
    let finite = |p: &(f64, f64)| p.0.is_finite() && p.1.is_finite();
    let pieces = points.split(|p| !finite(p)).filter(|piece| !piece.is_empty());
    pieces.map(|piece| if runs_right(piece) { thin(piece) } else { piece.to_vec() }).collect()
}

fn runs_right(points: &[(f64, f64)]) -> bool {
    points.windows(2).all(|pair| pair[0].0 <= pair[1].0)
}

fn thin(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= MAX_SERIES_POINTS {
        return points.to_vec();
    }
    let column = points.len().div_ceil(MAX_SERIES_POINTS / 2);
    let by_height = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
    let mut kept = vec![points[0]];
    for chunk in points.chunks(column) {
        let low = chunk.iter().min_by(by_height).copied();
        let high = chunk.iter().max_by(by_height).copied();
        let (Some(low), Some(high)) = (low, high) else { continue };
        kept.extend(if low.0 <= high.0 { [low, high] } else { [high, low] });
    }
    kept.push(points[points.len() - 1]);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_peaks_and_ends() {
        let mut points: Vec<(f64, f64)> = (0..20_000).map(|i| (f64::from(i), f64::from(i).sin())).collect();
        points[7777].1 = 50.0;
        let kept = &pieces(&points)[0];
        assert!(kept.len() < 1600);
        assert!(kept.contains(&(7777.0, 50.0)));
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[19_999]));
        assert!(kept.windows(2).all(|pair| pair[0].0 <= pair[1].0));
    }

    #[test]
    fn gaps_split() {
        let split = pieces(&[(0.0, 1.0), (1.0, f64::NAN), (2.0, 1.0), (3.0, 2.0)]);
        assert_eq!(split, [vec![(0.0, 1.0)], vec![(2.0, 1.0), (3.0, 2.0)]]);
    }
}

//! A few of many points: those that stand out farthest, place by place.

use trundle_core::Vector2;

/// Eight directions, by x and y.
const DIRECTIONS: [(f64, f64); 8] =
    [(1., 0.), (1., 1.), (0., 1.), (-1., 1.), (-1., 0.), (-1., -1.), (0., -1.), (1., -1.)];

/// Of the points in each square of `side` (m), those that stand out farthest in eight directions.
pub fn sparse(points: &[(Vector2, u32)], side: f64) -> Vec<(Vector2, u32)> {
    let key = |p: &Vector2| ((p.x / side).floor() as i64, (p.y / side).floor() as i64);
    let mut sorted: Vec<((i64, i64), (Vector2, u32))> = points.iter().map(|p| (key(&p.0), *p)).collect();
    sorted.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.1.cmp(&b.1.1)));
    let mut kept = Vec::new();
    for group in sorted.chunk_by(|a, b| a.0 == b.0) {
        outermost(group.iter().map(|(_, point)| *point), &mut kept);
    }
    kept
}

/// Adds the points that stand out farthest in eight directions, each once.
fn outermost(points: impl Iterator<Item = (Vector2, u32)>, kept: &mut Vec<(Vector2, u32)>) {
    let mut best: [Option<(f64, (Vector2, u32))>; 8] = [None; 8];
    for point in points {
        for (best, (x, y)) in best.iter_mut().zip(DIRECTIONS) {
            let far = point.0.x * x + point.0.y * y;
            if best.is_none_or(|(most, _)| far > most) {
                *best = Some((far, point));
            }
        }
    }
    let first = kept.len();
    for (_, point) in best.into_iter().flatten() {
        if kept[first..].iter().all(|(_, number)| *number != point.1) {
            kept.push(point);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rim_of_a_square_of_points_is_kept() {
        let points: Vec<_> = (0..400u32)
            .map(|i| (Vector2::new(f64::from(i % 20) * 0.001, f64::from(i / 20) * 0.001), i))
            .collect();
        let kept = sparse(&points, 0.1);
        assert!(kept.len() <= 8);
        for corner in [0, 19, 380, 399] {
            assert!(kept.iter().any(|(_, number)| *number == corner), "{corner}");
        }
    }
}

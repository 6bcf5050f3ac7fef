use trundle_core::Vector2;

/// Points in square buckets, so that those near a place are found without looking at all.
#[derive(Debug, Clone, PartialEq)]
pub struct PointIndex {
    low: Vector2,
    columns: usize,
    rows: usize,
    /// Where each bucket begins in `points`; one more at the end.
    starts: Vec<u32>,
    points: Vec<(Vector2, u32)>,
}

/// Side of a bucket, m: a third of a usual footprint.
const BUCKET: f64 = 0.1;
/// Buckets a side at most; points of a greater area share the outermost ones.
const MOST: f64 = 2000.0;

impl PointIndex {
    /// Sorts finite points, each with a number of its own, into buckets.
    pub fn new(points: &[(Vector2, u32)]) -> Self {
        let bound = |f: fn(f64, f64) -> f64, from: f64| {
            points.iter().fold(Vector2::repeat(from), |b, (p, _)| Vector2::new(f(b.x, p.x), f(b.y, p.y)))
        };
        let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
        let side = |low: f64, high: f64| ((high - low) / BUCKET).clamp(0.0, MOST) as usize + 1;
        let mut index = Self {
            low,
            columns: side(low.x, high.x),
            rows: side(low.y, high.y),
            starts: Vec::new(),
            points: points.to_vec(),
        };
        index
            .points
            .sort_by_cached_key(|(p, number)| (index_of(&index.low, index.columns, index.rows, *p), *number));
        index.starts = vec![0; index.columns * index.rows + 1];
        for (p, _) in points {
            index.starts[index_of(&low, index.columns, index.rows, *p) + 1] += 1;
        }
        for i in 1..index.starts.len() {
            index.starts[i] += index.starts[i - 1];
        }
        index
    }

    /// All points.
    pub fn all(&self) -> &[(Vector2, u32)] {
        &self.points
    }

    /// Calls `visit` with every point of the buckets that a box about `center` touches.
    pub fn visit(&self, center: Vector2, half: Vector2, mut visit: impl FnMut(Vector2, u32)) {
        if self.points.is_empty() {
            return;
        }
        let (left, right) = span(center.x - self.low.x, half.x, self.columns);
        let (bottom, top) = span(center.y - self.low.y, half.y, self.rows);
        for row in bottom..top {
            let (from, to) = (row * self.columns + left, row * self.columns + right);
            if from < to {
                let range = self.starts[from] as usize..self.starts[to] as usize;
                self.points[range].iter().for_each(|&(p, number)| visit(p, number));
            }
        }
    }
}

/// Buckets along one axis, from and to.
fn span(offset: f64, half: f64, count: usize) -> (usize, usize) {
    let low = ((offset - half) / BUCKET).floor();
    let high = ((offset + half) / BUCKET).floor() + 1.0;
    let last = count as f64;
    if high <= 0.0 {
        return (0, 0);
    }
    // The outermost bucket also holds what lies beyond.
    let from = if low >= last { last - 1.0 } else { low.max(0.0) };
    (from as usize, high.clamp(from + 1.0, last.max(from + 1.0)) as usize)
}

fn index_of(low: &Vector2, columns: usize, rows: usize, p: Vector2) -> usize {
    let along = |offset: f64, count: usize| ((offset / BUCKET).floor().max(0.0) as usize).min(count - 1);
    along(p.y - low.y, rows) * columns + along(p.x - low.x, columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_finds_all_that_lie_in_it() {
        let points: Vec<_> = (0..500u32)
            .map(|i| (Vector2::new(f64::from(i * 37 % 101) * 0.031, f64::from(i * 53 % 97) * 0.027), i))
            .collect();
        let index = PointIndex::new(&points);
        let (center, half) = (Vector2::new(1.3, 1.1), 0.42);
        let mut found = Vec::new();
        index.visit(center, Vector2::repeat(half), |p, i| {
            if (p - center).amax() <= half {
                found.push(i);
            }
        });
        found.sort_unstable();
        let expected: Vec<u32> =
            points.iter().filter(|(p, _)| (p - center).amax() <= half).map(|(_, i)| *i).collect();
        assert_eq!(found, expected);
    }
}

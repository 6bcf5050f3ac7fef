use crate::field::FAR;
use trundle_core::GridGeometry;

/// The exact distance transform of \[Felzenszwalb12\] over cell squares, metres, into `out` (row-major).
///
/// `out` of a cell is the distance from its centre to the nearest point of the nearest occupied cell's square; 0 in
/// occupied cells, [`FAR`] where there is none. Two sweeps over the columns, then one lower envelope of parabolas a row:
/// O(cells). A parabola stands on each vertical cell edge: the nearest point of a square seen from another column's
/// centre lies on its near edge, so width + 1 parabolas are enough for distances to squares instead of centres.
pub(super) fn transform(
    geometry: &GridGeometry,
    outside_is_obstacle: bool,
    occupied: impl Fn(usize) -> bool,
    out: &mut Vec<f32>,
) {
    out.clear();
    out.resize(geometry.len(), 0.0);
    sweep_columns(geometry.width, outside_is_obstacle, occupied, out);
    let mut envelope = Envelope::new(geometry.width);
    for row in out.chunks_exact_mut(geometry.width) {
        envelope.transform_row(row, outside_is_obstacle, geometry.resolution);
    }
}

/// A count of cells that stands for "none in this column".
const NONE: f32 = 1e9;

/// Counts the cells to the nearest occupied one in the same column.
fn sweep_columns(width: usize, outside: bool, occupied: impl Fn(usize) -> bool, out: &mut [f32]) {
    let beyond = if outside { 1.0 } else { NONE };
    for i in 0..out.len() {
        out[i] = match (occupied(i), i.checked_sub(width)) {
            (true, _) => 0.0,
            (false, None) => beyond,
            (false, Some(below)) => out[below] + 1.0,
        };
    }
    for i in (0..out.len()).rev() {
        let above = out.get(i + width).map_or(beyond, |above| above + 1.0);
        out[i] = out[i].min(above);
    }
}

/// The lower envelope of parabolas standing on the vertical edges of a row's cells; lengths in cells.
struct Envelope {
    /// Squared vertical gap of each cell of the row.
    gap: Vec<f64>,
    /// Edge `e` (at e - 1/2) of each parabola of the envelope.
    edge: Vec<f64>,
    /// Its height.
    height: Vec<f64>,
    /// Where it begins to be the lowest.
    from: Vec<f64>,
}

impl Envelope {
    fn new(width: usize) -> Self {
        let buffer = || Vec::with_capacity(width + 1);
        Self { gap: buffer(), edge: buffer(), height: buffer(), from: buffer() }
    }

    fn transform_row(&mut self, row: &mut [f32], outside: bool, resolution: f64) {
        self.gap.clear();
        self.gap.extend(row.iter().map(|&count| squared_gap(count)));
        self.build(if outside { 0.0 } else { f64::INFINITY });
        let mut k = 0;
        for (x, out) in row.iter_mut().enumerate() {
            let at = x as f64;
            while k + 1 < self.from.len() && self.from[k + 1] <= at {
                k += 1;
            }
            let below = self.edge.get(k).map_or(f64::INFINITY, |edge| (at - edge).powi(2) + self.height[k]);
            *out = (below.min(self.gap[x]).sqrt() * resolution).min(FAR) as f32;
        }
    }

    fn build(&mut self, beyond: f64) {
        self.edge.clear();
        self.height.clear();
        self.from.clear();
        let width = self.gap.len();
        for e in 0..=width {
            let left = if e == 0 { beyond } else { self.gap[e - 1] };
            let right = if e == width { beyond } else { self.gap[e] };
            let height = left.min(right);
            if height.is_finite() {
                self.push(e as f64 - 0.5, height);
            }
        }
    }

    fn push(&mut self, edge: f64, height: f64) {
        let mut from = f64::NEG_INFINITY;
        while let (Some(&e), Some(&h), Some(&f)) = (self.edge.last(), self.height.last(), self.from.last()) {
            let meet = ((height + edge * edge) - (h + e * e)) / (2.0 * (edge - e));
            if meet > f {
                from = meet;
                break;
            }
            self.edge.pop();
            self.height.pop();
            self.from.pop();
        }
        self.edge.push(edge);
        self.height.push(height);
        self.from.push(from);
    }
}

/// The squared vertical gap, in cells, between a cell's centre and a square `count` rows away.
fn squared_gap(count: f32) -> f64 {
    if count >= NONE { f64::INFINITY } else { (f64::from(count) - 0.5).max(0.0).powi(2) }
}

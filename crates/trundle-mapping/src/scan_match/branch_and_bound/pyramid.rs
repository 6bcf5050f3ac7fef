//! Pyramid of maxima of the coarse likelihood of a map.

use trundle_grid::tiles::{Tile, TileMap};

/// Levels above the finest: squares of 2, 4, 8 and 16 samples. Source: ours.
pub(crate) const PYRAMID_LEVELS: usize = 4;
/// Number of samples along a tile's side.
const SAMPLES_PER_TILE_SIDE: usize = Tile::SIDE / 2;
/// Margin about the map [samples]: side of the largest square.
const MARGIN_SAMPLES: usize = 1 << PYRAMID_LEVELS;
/// Maximum number of samples. A larger map (2 km x 2 km at 5 cm) has no pyramid. Source: ours.
const MAX_SAMPLES: usize = 64_000_000;

/// The coarse likelihood of a map, and for each power of two the maximum within the square that begins at a sample.
#[derive(Debug, Clone)]
pub(crate) struct Pyramid {
    /// The sample at the lower left.
    first: (i32, i32),
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) levels: Vec<Vec<u8>>,
}

impl Pyramid {
    /// The pyramid of all tiles of a map; `None` for an empty or unbounded map. Cost: 5 passes over its area.
    pub(crate) fn new(map: &TileMap) -> Option<Self> {
        let (low, high) = map.extent()?;
        Self::of(map, low, high)
    }

    /// The pyramid of the tiles from `low` to `high`.
    pub(crate) fn of(map: &TileMap, low: (i32, i32), high: (i32, i32)) -> Option<Self> {
        let size =
            |low: i32, high: i32| (high - low + 1) as usize * SAMPLES_PER_TILE_SIDE + 2 * MARGIN_SAMPLES;
        let (width, height) = (size(low.0, high.0), size(low.1, high.1));
        if width.saturating_mul(height) > MAX_SAMPLES {
            return None;
        }
        let corner = |tile: i32| tile * SAMPLES_PER_TILE_SIDE as i32 - MARGIN_SAMPLES as i32;
        let mut finest = vec![0; width * height];
        let places = (low.1..=high.1).flat_map(|y| (low.0..=high.0).map(move |x| (x, y)));
        for (at, tile) in places.map(|at| (at, map.tile(at))) {
            let (col, row) = (
                (at.0 - low.0) as usize * SAMPLES_PER_TILE_SIDE + MARGIN_SAMPLES,
                (at.1 - low.1) as usize * SAMPLES_PER_TILE_SIDE + MARGIN_SAMPLES,
            );
            for (k, line) in tile.coarse.chunks_exact(SAMPLES_PER_TILE_SIDE).enumerate() {
                let to = (row + k) * width + col;
                finest[to..to + SAMPLES_PER_TILE_SIDE].copy_from_slice(line);
            }
        }
        let mut levels = vec![finest];
        for level in 1..=PYRAMID_LEVELS {
            levels.push(coarser(&levels[level - 1], width, height, 1 << (level - 1)));
        }
        Some(Self { first: (corner(low.0), corner(low.1)), width, height, levels })
    }

    /// The sample nearest to a point (cells of the map), counted from the lower left.
    pub(crate) fn sample(&self, x: f64, y: f64) -> (i32, i32) {
        // Samples are at the middles of even cells: 0.5, 2.5 and so on.
        let nearest = |v: f64| ((v + 0.5) * 0.5).floor() as i32;
        (nearest(x) - self.first.0, nearest(y) - self.first.1)
    }

    /// The middle of the map and half its extent, cells.
    pub(crate) fn bounds(&self) -> ((f64, f64), (f64, f64)) {
        let half = (self.width as f64, self.height as f64);
        ((f64::from(self.first.0) * 2.0 + half.0, f64::from(self.first.1) * 2.0 + half.1), half)
    }
}

/// Maximum of four samples `step` apart.
fn coarser(finer_cells: &[u8], width: usize, height: usize, step: usize) -> Vec<u8> {
    let mut rows = finer_cells.to_vec();
    for row in rows.chunks_exact_mut(width) {
        for x in 0..width - step {
            row[x] = row[x].max(row[x + step]);
        }
    }
    let split = (height - step) * width;
    let (low, high) = (rows.clone(), &rows);
    let mut out = low;
    for (value, above) in out[..split].iter_mut().zip(&high[step * width..]) {
        *value = (*value).max(*above);
    }
    out
}

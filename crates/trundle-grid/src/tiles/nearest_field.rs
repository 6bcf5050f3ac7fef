//! Incremental field of nearest obstacles.

use super::tile::{NearestObstacle, Tile, TileMap};
use std::ops::RangeInclusive;

/// Field of nearest obstacles, updated as obstacles appear and disappear. The comparison of a point with the field costs one lookup.
///
/// Every cell within `reach` cells of an obstacle stores the vector to the nearest obstacle point, in 1/16 cell. Cells at even coordinates
/// also store a likelihood of that distance, for the coarse search.
#[derive(Debug, Clone)]
pub struct NearestField {
    reach: i32,
    /// Likelihood, 0 to 255, by squared distance in quarters of a cell squared; the last entry applies without an obstacle.
    coarse: [u8; NOT_IN_REACH + 1],
}

impl NearestField {
    /// Maximum reach \[cells\]. A larger offset does not fit a byte. Source: ours.
    pub const MAX_REACH_CELLS: i32 = 6;

    /// Field with a reach of `reach` cells. The coarse likelihood is a Gaussian with a sigma of `sigma` cells.
    pub fn new(reach: i32, sigma: f64) -> Self {
        let mut coarse = [0; NOT_IN_REACH + 1];
        for (i, value) in coarse.iter_mut().take(NOT_IN_REACH).enumerate() {
            let squared = i as f64 / 4.0;
            *value = (255.0 * (-0.5 * squared / (sigma * sigma)).exp()).round() as u8;
        }
        Self { reach: reach.clamp(2, Self::MAX_REACH_CELLS), coarse }
    }

    /// Inserts or moves the obstacle point of a cell. It updates the cells nearest to this point, and the cells that stored its former
    /// position. `own` is the point's position in the cell.
    pub fn insert(&self, map: &mut TileMap, cell: (i32, i32), own: NearestObstacle) {
        let inside = |v: i32| {
            let within = v.rem_euclid(Tile::SIDE as i32);
            within >= self.reach && within + self.reach < Tile::SIDE as i32
        };
        if inside(cell.0) && inside(cell.1) {
            let part = |v: i32| v - self.reach..=v + self.reach;
            let tile = map.tile_mut(Tile::of_cell(cell.0, cell.1));
            self.offer(tile, (part(cell.0), part(cell.1)), cell, own);
            self.write(tile, cell, own);
            tile.set_own(cell.0, cell.1, true);
            return;
        }
        for_tiles_about(cell, self.reach, |tile_at, xs, ys| {
            let tile = map.tile_mut(tile_at);
            self.offer(tile, (xs, ys), cell, own);
            if tile_at == Tile::of_cell(cell.0, cell.1) {
                self.write(tile, cell, own);
                tile.set_own(cell.0, cell.1, true);
            }
        });
    }

    /// Compares an obstacle with the stored ones in a part of a tile.
    fn offer(&self, tile: &mut Tile, part: Part, cell: (i32, i32), own: NearestObstacle) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the only feature that the function is compiled for.
            return unsafe { self.offer_by_avx2(tile, part, cell, own) };
        }
        self.offer_portable(tile, part, cell, own);
    }

    /// [`Self::offer_rows`] compiled for vectors of 16 cells.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn offer_by_avx2(&self, tile: &mut Tile, part: Part, cell: (i32, i32), own: NearestObstacle) {
        self.offer_rows(tile, part, cell, own);
    }

    fn offer_portable(&self, tile: &mut Tile, part: Part, cell: (i32, i32), own: NearestObstacle) {
        self.offer_rows(tile, part, cell, own);
    }

    #[inline(always)]
    fn offer_rows(&self, tile: &mut Tile, (xs, ys): Part, cell: (i32, i32), own: NearestObstacle) {
        for y in ys {
            let step = (((cell.0 - xs.start()) << 4) as i16, ((cell.1 - y) << 4) as i16);
            self.offer_row(tile, (xs.clone(), y), step, own);
        }
    }

    /// Removes the obstacles of `cells` from the field. Cells that lose their nearest obstacle are compared with the obstacles of
    /// neighbouring cells: a Voronoi region is divided among its neighbours.
    pub fn remove(&self, map: &mut TileMap, cells: &[(i32, i32)]) {
        let mut lost = Vec::new();
        for &cell in cells {
            for_tiles_about(cell, self.reach, |tile_at, xs, ys| {
                let tile = map.tile_mut(tile_at);
                for y in ys {
                    for x in xs.clone() {
                        if target((x, y), tile.nearest[Tile::index(x, y)]) == Some(cell) {
                            self.write(tile, (x, y), NearestObstacle::NONE);
                            lost.push((x, y));
                            if (x, y) == cell {
                                tile.set_own(x, y, false);
                            }
                        }
                    }
                }
            });
        }
        let nearest = |(x, y): (i32, i32)| map.tile(Tile::of_cell(x, y)).nearest[Tile::index(x, y)];
        let neighbours = |&(x, y): &(i32, i32)| [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
        let mut heirs: Vec<_> =
            lost.iter().flat_map(neighbours).filter_map(|at| target(at, nearest(at))).collect();
        heirs.sort_unstable();
        heirs.dedup();
        let heirs: Vec<_> = heirs.into_iter().map(|cell| (cell, nearest(cell))).collect();
        for (cell, own) in heirs {
            self.insert(map, cell, own);
        }
    }

    /// Compares an obstacle with the stored ones in a row of a tile. `step` is the vector from the first cell to the centre of the
    /// obstacle's cell.
    ///
    /// The loops have no branches and use 16-bit arithmetic, which lets the compiler vectorise them. Squares are below 2^15 within reach,
    /// and the square of `NONE` is 2^15.
    #[inline(always)]
    fn offer_row(
        &self,
        tile: &mut Tile,
        (xs, y): (RangeInclusive<i32>, i32),
        step: (i16, i16),
        own: NearestObstacle,
    ) {
        // Sixteen cells of the tile's row. Those from `low` to `high` are within reach.
        let column = (*xs.start() as usize % Tile::SIDE).min(Tile::SIDE - LANES);
        let low = *xs.start() as usize % Tile::SIDE - column;
        let high = (low as i32 + xs.end() - xs.start()) as i16;
        let (low, from_x) = (low as i16, step.0 + 16 * low as i16);
        let first = ((y as usize % Tile::SIDE) << Tile::BITS) + column;
        let (step_y, own_x, own_y) = (step.1, i16::from(own.x()), i16::from(own.y()));
        let row = tile.nearest[first..].first_chunk_mut::<LANES>();
        let row = row.expect("invariant: a row of a tile holds 32 cells");
        let (mut old_x, mut old_y) = ([0_i16; LANES], [0_i16; LANES]);
        for k in 0..LANES {
            let both = row[k].packed();
            (old_x[k], old_y[k]) = ((both << 8) >> 8, both >> 8);
        }
        let mut taken = [0_i16; LANES];
        for k in 0..LANES {
            let step_x = STEPS[k].wrapping_add(from_x);
            let (dx, dy) = (step_x.wrapping_add(own_x), step_y.wrapping_add(own_y));
            // The square of `NONE` saturates at 2^15 - 1.
            let old = old_x[k].wrapping_mul(old_x[k]).saturating_add(old_y[k].wrapping_mul(old_y[k]));
            let nearer = mask(dx.wrapping_mul(dx).wrapping_add(dy.wrapping_mul(dy)) < old);
            let others = !(within(old_x[k]) & within(old_y[k]));
            let held = within(old_x[k].wrapping_sub(step_x)) & within(old_y[k].wrapping_sub(step_y));
            let in_reach = mask(COLUMNS[k] >= low) & mask(COLUMNS[k] <= high);
            taken[k] = ((nearer & others) | held) & in_reach;
            old_x[k] = (dx & taken[k]) | (old_x[k] & !taken[k]);
            old_y[k] = (dy & taken[k]) | (old_y[k] & !taken[k]);
        }
        let changed = taken.iter().fold(0, |all, t| all | t) != 0;
        let mut quarters = [0_u16; LANES];
        for k in 0..LANES {
            row[k] = NearestObstacle::from_packed((old_x[k] & 255) | (old_y[k] << 8));
            let squared = old_x[k].wrapping_mul(old_x[k]).wrapping_add(old_y[k].wrapping_mul(old_y[k]));
            quarters[k] = squared as u16 >> 6;
        }
        if changed && y & 1 == 0 {
            for x in xs.filter(|x| x & 1 == 0) {
                let lane = (x as usize % Tile::SIDE - column) % LANES;
                let value = self.coarse[usize::from(quarters[lane]).min(NOT_IN_REACH)];
                tile.coarse[Tile::coarse_index(x, y)] = value;
            }
        }
    }

    /// Computes the coarse likelihood of a tile from its nearest obstacles.
    pub fn fill_coarse(&self, tile: &mut Tile) {
        let side = Tile::SIDE as i32;
        for (x, y) in (0..side).step_by(2).flat_map(|y| (0..side).step_by(2).map(move |x| (x, y))) {
            self.write(tile, (x, y), tile.nearest[Tile::index(x, y)]);
        }
    }

    #[inline]
    fn write(&self, tile: &mut Tile, at: (i32, i32), nearest: NearestObstacle) {
        tile.nearest[Tile::index(at.0, at.1)] = nearest;
        if let Some(place) = Tile::coarse_index_if_even(at.0, at.1) {
            let quarters = (nearest.squared() >> 6) as usize;
            tile.coarse[place] = self.coarse[quarters.min(NOT_IN_REACH)];
        }
    }
}

/// Visits the square of `reach` cells about a cell, tile by tile: the tile, its columns and its rows, in cells.
fn for_tiles_about(
    (x, y): (i32, i32),
    reach: i32,
    mut visit: impl FnMut((i32, i32), RangeInclusive<i32>, RangeInclusive<i32>),
) {
    let (low, high) = ((x - reach, y - reach), (x + reach, y + reach));
    for tile_y in low.1 >> Tile::BITS..=high.1 >> Tile::BITS {
        for tile_x in low.0 >> Tile::BITS..=high.0 >> Tile::BITS {
            let span = |tile: i32, low: i32, high: i32| {
                let first = tile << Tile::BITS;
                low.max(first)..=high.min(first + Tile::SIDE as i32 - 1)
            };
            visit((tile_x, tile_y), span(tile_x, low.0, high.0), span(tile_y, low.1, high.1));
        }
    }
}

/// Columns and rows.
type Part = (RangeInclusive<i32>, RangeInclusive<i32>);

/// Index of [`NearestObstacle::NONE`] in the table of likelihoods: its squared distance in quarters of a cell squared. Distances
/// within reach have lower indices. Source: ours.
const NOT_IN_REACH: usize = 512;
/// Cells of one vector: at least as many as an obstacle reaches across.
const LANES: usize = 16;
/// Index of each lane.
const COLUMNS: [i16; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
/// Offset from the centre of a lane's cell to that of lane 0, 1/16 cells.
const STEPS: [i16; LANES] =
    [0, -16, -32, -48, -64, -80, -96, -112, -128, -144, -160, -176, -192, -208, -224, -240];

/// All bits set or none.
#[inline]
fn mask(condition: bool) -> i16 {
    -i16::from(condition)
}

/// Whether an offset may be within its own cell, as a mask.
#[inline]
fn within(v: i16) -> i16 {
    mask(v <= NearestObstacle::MAX_OWN_OFFSET as i16) & mask(v >= -NearestObstacle::MAX_OWN_OFFSET as i16)
}

/// Cell that contains the nearest obstacle of a cell.
#[inline]
fn target((x, y): (i32, i32), nearest: NearestObstacle) -> Option<(i32, i32)> {
    let step = |offset: i8| (i32::from(offset) + NearestObstacle::PER_CELL / 2) >> 4;
    (!nearest.is_none()).then(|| (x + step(nearest.x()), y + step(nearest.y())))
}

const _: () = assert!(Tile::COARSE_SIDE * 2 == Tile::SIDE && NearestObstacle::PER_CELL == 16);

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    fn nearest(map: &TileMap, (x, y): (i32, i32)) -> NearestObstacle {
        map.tile(Tile::of_cell(x, y)).nearest[Tile::index(x, y)]
    }

    proptest! {
        #[test]
        fn vector_code_and_portable_code_agree(
            obstacles in prop::collection::vec(((0..32_i32, 0..32_i32), (-7..=7_i32, -7..=7_i32)), 1..40),
        ) {
            let model = NearestField::new(4, 2.0);
            let (mut portable, mut vectors) = (Tile::UNKNOWN, Tile::UNKNOWN);
            for (cell, (x, y)) in obstacles {
                let part = |c: i32| (c - 4).max(0)..=(c + 4).min(31);
                let part = (part(cell.0), part(cell.1));
                model.offer_portable(&mut portable, part.clone(), cell, NearestObstacle::own(x, y));
                model.offer(&mut vectors, part, cell, NearestObstacle::own(x, y));
            }
            prop_assert!(portable.nearest == vectors.nearest && portable.coarse == vectors.coarse);
        }

        #[test]
        fn agrees_with_brute_force(
            obstacles in prop::collection::btree_map((-20..20_i32, -20..20_i32), (-7..=7_i32, -7..=7_i32), 0..40),
            gone in prop::collection::vec(any::<prop::sample::Index>(), 0..20),
        ) {
            let model = NearestField::new(6, 2.0);
            let (mut map, mut left) = (TileMap::default(), BTreeMap::new());
            for (&cell, &(x, y)) in &obstacles {
                model.insert(&mut map, cell, NearestObstacle::own(x, y));
                left.insert(cell, (x, y));
            }
            let cells: Vec<_> = obstacles.keys().copied().collect();
            let mut removed: Vec<_> = gone.iter().filter(|_| !cells.is_empty()).map(|i| *i.get(&cells)).collect();
            removed.sort_unstable();
            removed.dedup();
            model.remove(&mut map, &removed);
            for cell in removed {
                left.remove(&cell);
            }
            let (mut all, mut wrong) = (0, 0);
            for y in -27..27 {
                for x in -27..27 {
                    let in_reach = left.iter().filter(|((ox, oy), _)| (ox - x).abs() <= 6 && (oy - y).abs() <= 6);
                    let best = match left.get(&(x, y)) {
                        Some((px, py)) => Some(px * px + py * py),
                        None => in_reach
                            .map(|((ox, oy), (px, py))| ((ox - x) * 16 + px).pow(2) + ((oy - y) * 16 + py).pow(2))
                            .min(),
                    };
                    let found = nearest(&map, (x, y));
                    // No removed obstacle is stored. The nearest obstacle is exact except at corners of Voronoi regions.
                    if let Some(cell) = target((x, y), found) {
                        prop_assert!(left.contains_key(&cell), "{cell:?} was removed");
                    }
                    all += 1;
                    wrong += usize::from((!found.is_none()).then(|| found.squared()) != best);
                }
            }
            prop_assert!(wrong * 100 <= all, "{wrong} of {all}");
            for (y, x) in (-32..32).flat_map(|y| (-32..32).map(move |x| (y, x))) {
                let tile = map.tile(Tile::of_cell(x, y));
                prop_assert_eq!(tile.own[(y & 31) as usize] >> (x & 31) & 1 == 1, left.contains_key(&(x, y)));
            }
        }
    }
}

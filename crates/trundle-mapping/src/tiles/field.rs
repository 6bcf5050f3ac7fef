use std::ops::RangeInclusive;

use super::{
    map::TileMap,
    tile::{COARSE_SIDE, Nearest, TILE_BITS, TILE_SIDE, Tile},
};

/// The field of nearest obstacles: kept up to date as obstacles come and go, so that matching a point is one look-up.
///
/// Every cell within `reach` cells of an obstacle knows the vector to the nearest one, to 1/16 cell; cells at even
/// coordinates also hold a likelihood of that distance, for the coarse search.
#[derive(Debug, Clone)]
pub(crate) struct FieldModel {
    reach: i32,
    /// Likelihood 0 to 255 by squared distance in quarters of a cell squared; the last is that of none.
    coarse: [u8; NOT_IN_REACH + 1],
}

impl FieldModel {
    /// Farthest reach, cells: what an offset in a byte can hold.
    pub(crate) const MOST_REACH: i32 = 6;

    /// A field that reaches `reach` cells; the coarse likelihood falls off with `sigma` cells.
    pub(crate) fn new(reach: i32, sigma: f64) -> Self {
        let mut coarse = [0; NOT_IN_REACH + 1];
        for (i, value) in coarse.iter_mut().take(NOT_IN_REACH).enumerate() {
            let squared = i as f64 / 4.0;
            *value = (255.0 * (-0.5 * squared / (sigma * sigma)).exp()).round() as u8;
        }
        Self { reach: reach.clamp(2, Self::MOST_REACH), coarse }
    }

    /// Makes the cell's obstacle known to the cells about it: those for which it is the nearest, and those that
    /// held it for the nearest before it moved within its cell. `own` is where in the cell it is now.
    pub(crate) fn place(&self, map: &mut TileMap, cell: (i32, i32), own: Nearest) {
        let inside = |v: i32| {
            let within = v.rem_euclid(TILE_SIDE as i32);
            within >= self.reach && within + self.reach < TILE_SIDE as i32
        };
        if inside(cell.0) && inside(cell.1) {
            let part = |v: i32| v - self.reach..=v + self.reach;
            let tile = map.tile_mut((cell.0 >> TILE_BITS, cell.1 >> TILE_BITS));
            self.offer(tile, (part(cell.0), part(cell.1)), cell, own);
            self.write(tile, cell, own);
            tile.set_own(cell.0, cell.1, true);
            return;
        }
        for_tiles_about(cell, self.reach, |tile_at, xs, ys| {
            let tile = map.tile_mut(tile_at);
            self.offer(tile, (xs, ys), cell, own);
            if tile_at == (cell.0 >> TILE_BITS, cell.1 >> TILE_BITS) {
                self.write(tile, cell, own);
                tile.set_own(cell.0, cell.1, true);
            }
        });
    }

    /// Offers an obstacle to these columns and rows of a tile.
    fn offer(&self, tile: &mut Tile, part: Part, cell: (i32, i32), own: Nearest) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the one feature that the function is compiled for.
            return unsafe { self.offer_by_avx2(tile, part, cell, own) };
        }
        self.offer_plainly(tile, part, cell, own);
    }

    /// The same arithmetic in vectors of sixteen.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn offer_by_avx2(&self, tile: &mut Tile, part: Part, cell: (i32, i32), own: Nearest) {
        self.offer_each(tile, part, cell, own);
    }

    fn offer_plainly(&self, tile: &mut Tile, part: Part, cell: (i32, i32), own: Nearest) {
        self.offer_each(tile, part, cell, own);
    }

    #[inline(always)]
    fn offer_each(&self, tile: &mut Tile, (xs, ys): Part, cell: (i32, i32), own: Nearest) {
        for y in ys {
            let step = (((cell.0 - xs.start()) << 4) as i16, ((cell.1 - y) << 4) as i16);
            self.offer_row(tile, (xs.clone(), y), step, own);
        }
    }

    /// Takes the obstacles of `cells` out of the field. The cells that lose their nearest one get those of the cells
    /// beside them offered: a Voronoi region is divided among its neighbours.
    pub(crate) fn remove(&self, map: &mut TileMap, cells: &[(i32, i32)]) {
        let mut lost = Vec::new();
        for &cell in cells {
            for_tiles_about(cell, self.reach, |tile_at, xs, ys| {
                let tile = map.tile_mut(tile_at);
                for y in ys {
                    for x in xs.clone() {
                        if target((x, y), tile.nearest[Tile::place(x, y)]) == Some(cell) {
                            self.write(tile, (x, y), Nearest::NONE);
                            lost.push((x, y));
                            if (x, y) == cell {
                                tile.set_own(x, y, false);
                            }
                        }
                    }
                }
            });
        }
        let nearest =
            |(x, y): (i32, i32)| map.tile((x >> TILE_BITS, y >> TILE_BITS)).nearest[Tile::place(x, y)];
        let beside = |&(x, y): &(i32, i32)| [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
        let mut heirs: Vec<_> =
            lost.iter().flat_map(beside).filter_map(|at| target(at, nearest(at))).collect();
        heirs.sort_unstable();
        heirs.dedup();
        let heirs: Vec<_> = heirs.into_iter().map(|cell| (cell, nearest(cell))).collect();
        for (cell, own) in heirs {
            self.place(map, cell, own);
        }
    }

    /// Offers an obstacle to the cells of a row of a tile; `step` leads from the first to the middle of its cell.
    ///
    /// Without branches, in 16-bit arithmetic: the compiler makes it vector code. Squares stay below 2^15 within reach,
    /// and that of `NONE` is 2^15.
    #[inline(always)]
    fn offer_row(
        &self,
        tile: &mut Tile,
        (xs, y): (RangeInclusive<i32>, i32),
        step: (i16, i16),
        own: Nearest,
    ) {
        // Sixteen cells of the tile's row, of which those from `low` to `high` are within reach.
        let column = (*xs.start() as usize % TILE_SIDE).min(TILE_SIDE - LANES);
        let low = *xs.start() as usize % TILE_SIDE - column;
        let high = (low as i32 + xs.end() - xs.start()) as i16;
        let (low, from_x) = (low as i16, step.0 + 16 * low as i16);
        let first = ((y as usize % TILE_SIDE) << TILE_BITS) + column;
        let (step_y, own_x, own_y) = (step.1, i16::from(own.x()), i16::from(own.y()));
        let row = tile.nearest[first..].first_chunk_mut::<LANES>();
        let row = row.expect("invariant: a row of a tile holds twice as many");
        let (mut old_x, mut old_y) = ([0_i16; LANES], [0_i16; LANES]);
        for k in 0..LANES {
            let both = row[k].packed();
            (old_x[k], old_y[k]) = ((both << 8) >> 8, both >> 8);
        }
        let mut taken = [0_i16; LANES];
        for k in 0..LANES {
            let step_x = STEPS[k].wrapping_add(from_x);
            let (dx, dy) = (step_x.wrapping_add(own_x), step_y.wrapping_add(own_y));
            // That of `NONE` saturates at 2^15 - 1.
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
            row[k] = Nearest::from_packed((old_x[k] & 255) | (old_y[k] << 8));
            let squared = old_x[k].wrapping_mul(old_x[k]).wrapping_add(old_y[k].wrapping_mul(old_y[k]));
            quarters[k] = squared as u16 >> 6;
        }
        if changed && y & 1 == 0 {
            for x in xs.filter(|x| x & 1 == 0) {
                let lane = (x as usize % TILE_SIDE - column) % LANES;
                let value = self.coarse[usize::from(quarters[lane]).min(NOT_IN_REACH)];
                tile.coarse[Tile::coarse_index(x, y)] = value;
            }
        }
    }

    /// Fills in the coarse field of a tile from its nearest obstacles.
    pub(crate) fn fill_coarse(&self, tile: &mut Tile) {
        let side = TILE_SIDE as i32;
        for (x, y) in (0..side).step_by(2).flat_map(|y| (0..side).step_by(2).map(move |x| (x, y))) {
            self.write(tile, (x, y), tile.nearest[Tile::place(x, y)]);
        }
    }

    #[inline]
    fn write(&self, tile: &mut Tile, at: (i32, i32), nearest: Nearest) {
        tile.nearest[Tile::place(at.0, at.1)] = nearest;
        if let Some(place) = Tile::coarse_place(at.0, at.1) {
            let quarters = (nearest.squared() >> 6) as usize;
            tile.coarse[place] = self.coarse[quarters.min(NOT_IN_REACH)];
        }
    }
}

/// The parts of the square of `reach` cells about a cell, tile by tile: the tile, its columns and its rows, in cells.
fn for_tiles_about(
    (x, y): (i32, i32),
    reach: i32,
    mut each: impl FnMut((i32, i32), RangeInclusive<i32>, RangeInclusive<i32>),
) {
    let (low, high) = ((x - reach, y - reach), (x + reach, y + reach));
    for tile_y in low.1 >> TILE_BITS..=high.1 >> TILE_BITS {
        for tile_x in low.0 >> TILE_BITS..=high.0 >> TILE_BITS {
            let span = |tile: i32, low: i32, high: i32| {
                let first = tile << TILE_BITS;
                low.max(first)..=high.min(first + TILE_SIDE as i32 - 1)
            };
            each((tile_x, tile_y), span(tile_x, low.0, high.0), span(tile_y, low.1, high.1));
        }
    }
}

/// Columns and rows.
type Part = (RangeInclusive<i32>, RangeInclusive<i32>);

/// The squared distance of [`Nearest::NONE`], quarters of a cell squared; those within reach are less.
const NOT_IN_REACH: usize = 512;
/// Cells that are looked at in one go: at least as many as an obstacle reaches across.
const LANES: usize = 16;
const COLUMNS: [i16; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
/// From the middle of a lane's cell to that of lane 0, 1/16 cells.
const STEPS: [i16; LANES] =
    [0, -16, -32, -48, -64, -80, -96, -112, -128, -144, -160, -176, -192, -208, -224, -240];

/// All bits or none.
#[inline]
fn mask(condition: bool) -> i16 {
    -i16::from(condition)
}

/// Whether an offset may lie in its own cell.
#[inline]
fn within(v: i16) -> i16 {
    mask(v <= Nearest::OWN as i16) & mask(v >= -Nearest::OWN as i16)
}

/// The cell whose obstacle a cell holds for the nearest.
#[inline]
fn target((x, y): (i32, i32), nearest: Nearest) -> Option<(i32, i32)> {
    let step = |offset: i8| (i32::from(offset) + Nearest::PER_CELL / 2) >> 4;
    (!nearest.is_none()).then(|| (x + step(nearest.x()), y + step(nearest.y())))
}

const _: () = assert!(COARSE_SIDE * 2 == TILE_SIDE && Nearest::PER_CELL == 16);

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    fn nearest(map: &TileMap, (x, y): (i32, i32)) -> Nearest {
        map.tile((x >> TILE_BITS, y >> TILE_BITS)).nearest[Tile::place(x, y)]
    }

    proptest! {
        #[test]
        fn vectors_do_what_plain_code_does(
            obstacles in prop::collection::vec(((0..32_i32, 0..32_i32), (-7..=7_i32, -7..=7_i32)), 1..40),
        ) {
            let model = FieldModel::new(4, 2.0);
            let (mut plain, mut vectors) = (Tile::EMPTY, Tile::EMPTY);
            for (cell, (x, y)) in obstacles {
                let part = |c: i32| (c - 4).max(0)..=(c + 4).min(31);
                let part = (part(cell.0), part(cell.1));
                model.offer_plainly(&mut plain, part.clone(), cell, Nearest::own(x, y));
                model.offer(&mut vectors, part, cell, Nearest::own(x, y));
            }
            prop_assert!(plain.nearest == vectors.nearest && plain.coarse == vectors.coarse);
        }

        #[test]
        fn is_what_brute_force_finds(
            obstacles in prop::collection::btree_map((-20..20_i32, -20..20_i32), (-7..=7_i32, -7..=7_i32), 0..40),
            gone in prop::collection::vec(any::<prop::sample::Index>(), 0..20),
        ) {
            let model = FieldModel::new(6, 2.0);
            let (mut map, mut left) = (TileMap::default(), BTreeMap::new());
            for (&cell, &(x, y)) in &obstacles {
                model.place(&mut map, cell, Nearest::own(x, y));
                left.insert(cell, (x, y));
            }
            let cells: Vec<_> = obstacles.keys().copied().collect();
            let mut gone: Vec<_> = gone.iter().filter(|_| !cells.is_empty()).map(|i| *i.get(&cells)).collect();
            gone.sort_unstable();
            gone.dedup();
            model.remove(&mut map, &gone);
            for cell in gone {
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
                    // Nothing that is gone is remembered, and the nearest is found but for corners of regions.
                    if let Some(cell) = target((x, y), found) {
                        prop_assert!(left.contains_key(&cell), "{cell:?} is gone");
                    }
                    all += 1;
                    wrong += usize::from((!found.is_none()).then(|| found.squared()) != best);
                }
            }
            prop_assert!(wrong * 100 <= all, "{wrong} of {all}");
            for (y, x) in (-32..32).flat_map(|y| (-32..32).map(move |x| (y, x))) {
                let tile = map.tile((x >> TILE_BITS, y >> TILE_BITS));
                prop_assert_eq!(tile.own[(y & 31) as usize] >> (x & 31) & 1 == 1, left.contains_key(&(x, y)));
            }
        }
    }
}

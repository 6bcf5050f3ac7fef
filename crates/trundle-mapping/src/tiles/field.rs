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
    /// Likelihood 0 to 255 by squared distance in quarters of a cell squared.
    coarse: [u8; 512],
}

impl FieldModel {
    /// Farthest reach, cells: what an offset in a byte can hold.
    pub(crate) const MOST_REACH: i32 = 6;

    /// A field that reaches `reach` cells; the coarse likelihood falls off with `sigma` cells.
    pub(crate) fn new(reach: i32, sigma: f64) -> Self {
        let mut coarse = [0; 512];
        for (i, value) in coarse.iter_mut().enumerate() {
            let squared = i as f64 / 4.0;
            *value = (255.0 * (-0.5 * squared / (sigma * sigma)).exp()).round() as u8;
        }
        Self { reach: reach.clamp(2, Self::MOST_REACH), coarse }
    }

    /// Makes the cell's obstacle known to the cells about it. `own` is where in the cell it is.
    pub(crate) fn place(&self, map: &mut TileMap, cell: (i32, i32), own: Nearest) {
        self.for_tiles_about(cell, self.reach, |tile_at, xs, ys| {
            let tile = map.tile_mut(tile_at);
            for y in ys {
                let dy = (cell.1 - y) * Nearest::PER_CELL + i32::from(own.y);
                for x in xs.clone() {
                    let dx = (cell.0 - x) * Nearest::PER_CELL + i32::from(own.x);
                    self.offer(tile, (x, y), (dx, dy), cell);
                }
            }
        });
    }

    /// Takes the obstacles of `cells` out of the field, and makes those that stay known where the gone ones were nearest.
    pub(crate) fn remove(&self, map: &mut TileMap, cells: &[(i32, i32)]) {
        for &cell in cells {
            self.for_tiles_about(cell, self.reach, |tile_at, xs, ys| {
                let tile = map.tile_mut(tile_at);
                for y in ys {
                    for x in xs.clone() {
                        if target((x, y), tile.nearest[Tile::place(x, y)]) == Some(cell) {
                            self.write(tile, (x, y), Nearest::NONE);
                        }
                    }
                }
            });
        }
        for &cell in cells {
            self.restore(map, cell);
        }
    }

    /// Offers every obstacle near a gone one to the cells that may have lost theirs.
    fn restore(&self, map: &mut TileMap, gone: (i32, i32)) {
        let mut near = Vec::new();
        self.for_tiles_about(gone, 2 * self.reach, |tile_at, xs, ys| {
            let tile = map.tile(tile_at);
            for y in ys {
                for x in xs.clone() {
                    let nearest = tile.nearest[Tile::place(x, y)];
                    if !nearest.is_none() && nearest.is_own() {
                        near.push(((x, y), nearest));
                    }
                }
            }
        });
        for (cell, own) in near {
            self.place(map, cell, own);
        }
    }

    #[inline]
    fn offer(&self, tile: &mut Tile, at: (i32, i32), (dx, dy): (i32, i32), cell: (i32, i32)) {
        let place = Tile::place(at.0, at.1);
        let old = tile.nearest[place];
        if at == cell {
            self.write(tile, at, Nearest { x: dx as i8, y: dy as i8 });
            return;
        }
        let replaces = old.is_none()
            || (!old.is_own() && (dx * dx + dy * dy < old.squared() || target(at, old) == Some(cell)));
        if replaces {
            self.write(tile, at, Nearest { x: dx as i8, y: dy as i8 });
        }
    }

    #[inline]
    fn write(&self, tile: &mut Tile, at: (i32, i32), nearest: Nearest) {
        tile.nearest[Tile::place(at.0, at.1)] = nearest;
        if let Some(place) = Tile::coarse_place(at.0, at.1) {
            let quarters = (nearest.squared() >> 6) as usize;
            tile.coarse[place] = if nearest.is_none() { 0 } else { self.coarse[quarters.min(511)] };
        }
    }

    /// The parts of the square of `reach` cells about a cell, tile by tile: the tile, its columns and its rows, in cells.
    fn for_tiles_about(
        &self,
        (x, y): (i32, i32),
        reach: i32,
        mut each: impl FnMut((i32, i32), std::ops::RangeInclusive<i32>, std::ops::RangeInclusive<i32>),
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
}

/// The cell whose obstacle a cell holds for the nearest.
#[inline]
fn target((x, y): (i32, i32), nearest: Nearest) -> Option<(i32, i32)> {
    let step = |offset: i8| (i32::from(offset) + Nearest::PER_CELL / 2) >> 4;
    (!nearest.is_none()).then(|| (x + step(nearest.x), y + step(nearest.y)))
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
                    prop_assert_eq!((!found.is_none()).then(|| found.squared()), best, "at {} {}", x, y);
                }
            }
        }
    }
}

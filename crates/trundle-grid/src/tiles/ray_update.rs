//! Update of a map of tiles by the rays of one scan.

use super::{
    cell_mask::CellMask,
    free_update::FreeUpdate,
    nearest_field::NearestField,
    scan_rays::{RaySpan, ScanRays},
    stepped_ray::SteppedRay,
    tile::{NearestObstacle, Tile, TileMap},
};
use crate::MapperConfig;
use trundle_core::{Cell, Hypotenuse, Pose2};

/// Update of a [`TileMap`] by the rays of one scan: the inverse sensor model in units of the tiles.
#[derive(Debug, Clone)]
pub struct RayUpdate {
    hit: i8,
    high: i8,
    low: i8,
    free: FreeUpdate,
    /// Blind range, cells.
    blind_cells: f64,
    /// Field of nearest obstacles that the update maintains.
    pub nearest: NearestField,
}

/// Buffers, reused from scan to scan.
#[derive(Debug, Clone, Default)]
pub struct RayUpdateScratch {
    /// Cells with hits, and surfaces between them: free rays do not clear these cells.
    surface: CellMask,
    /// Cells that free rays passed beyond the blind range.
    free: CellMask,
    /// Cells that free rays passed within the blind range.
    near: CellMask,
    ends: Vec<End>,
    hits: Vec<HitCell>,
    removed: Vec<(i32, i32)>,
}

/// End of a ray in the map, cells.
#[derive(Debug, Clone, Copy)]
struct End {
    x: f64,
    y: f64,
    hit: bool,
    joined: bool,
    whole: bool,
    weight: f32,
}

#[derive(Debug, Clone, Copy)]
struct HitCell {
    cell: (i32, i32),
    sum: (f64, f64),
    count: f64,
    weight: f32,
}

impl RayUpdate {
    /// Update with the inverse sensor model of `config`, maintaining `nearest`.
    pub fn new(config: &MapperConfig, nearest: NearestField) -> Self {
        let units = |log_odds: f64| (log_odds / Tile::LOG_ODDS_UNIT).round().clamp(1.0, 127.0) as i8;
        let (free, low) = (units(config.free), -units(config.clamp_low));
        // An obstacle is removed at these log-odds.
        let removed_at = (-2 * i16::from(free)).max(i16::from(low) + 1) as i8;
        Self {
            hit: units(config.hit),
            high: units(config.clamp_high),
            low,
            free: FreeUpdate::new(free, low, removed_at),
            blind_cells: config.blind_range / config.resolution,
            nearest,
        }
    }

    /// Updates the map by a scan taken at `pose` (cells, rad). Each cell is updated once; a hit overrides a free ray. Returns the
    /// number of updated cells.
    pub fn apply(
        &self,
        map: &mut TileMap,
        scratch: &mut RayUpdateScratch,
        pose: Pose2,
        scan: &ScanRays,
    ) -> usize {
        let origin = scratch.find_ends(pose, scan, self.blind_cells > 0.0);
        if scratch.ends.is_empty() {
            return 0;
        }
        scratch.find_hits();
        scratch.mark_surfaces();
        scratch.mark_free(origin, &scan.spans, self.blind_cells);
        let RayUpdateScratch { surface, free, near, hits, removed, .. } = scratch;
        removed.clear();
        let mut cells = hits.len() + self.free.apply(map, (free, surface), i8::MAX, removed);
        if self.blind_cells > 0.0 {
            surface.add(free);
            cells += self.free.apply(map, (near, surface), 0, removed);
        }
        if !removed.is_empty() {
            self.nearest.remove(map, removed);
        }
        for hit in hits.iter() {
            self.hit(map, hit);
        }
        cells
    }

    /// Sets a cell to the clamp of its class in an occupancy grid. An unknown cell is not changed.
    pub fn set(&self, map: &mut TileMap, (x, y): (i32, i32), cell: Cell) {
        let log_odds = match cell {
            Cell::Unknown => return,
            Cell::Free => self.low,
            Cell::Occupied => self.high,
        };
        map.tile_mut(Tile::of_cell(x, y)).log_odds[Tile::index(x, y)] = log_odds;
        if cell == Cell::Occupied {
            let own = NearestObstacle::own(0, 0);
            map.tile_mut(Tile::of_cell(x, y)).nearest[Tile::index(x, y)] = own;
            self.nearest.insert(map, (x, y), own);
        }
    }

    /// Adds a hit to a cell. A cell with positive log-odds is an obstacle at the mean of its hits.
    fn hit(&self, map: &mut TileMap, hit: &HitCell) {
        let (x, y) = hit.cell;
        let tile = map.tile_mut(Tile::of_cell(x, y));
        let index = Tile::index(x, y);
        let old = tile.log_odds[index];
        let rise = (f32::from(self.hit) * hit.weight).round().max(1.0) as i8;
        let new = old.saturating_add(rise).min(self.high);
        tile.log_odds[index] = new;
        let before = tile.nearest[index];
        if new <= 0 {
            return;
        }
        let offset = |sum: f64, cell: i32| {
            ((sum / hit.count - f64::from(cell) - 0.5) * f64::from(NearestObstacle::PER_CELL)).round() as i32
        };
        let there = (offset(hit.sum.0, x), offset(hit.sum.1, y));
        let was_own = before.is_own();
        let own = if was_own {
            let visits = f64::from(old.max(0)) / f64::from(self.hit);
            let rate = if old >= self.high { MEAN_HIT_RATE } else { 1.0 / (1.0 + visits) };
            let mean =
                |was: i8, is: i32| i32::from(was) + (f64::from(is - i32::from(was)) * rate).round() as i32;
            NearestObstacle::own(mean(before.x(), there.0), mean(before.y(), there.1))
        } else {
            NearestObstacle::own(there.0, there.1)
        };
        tile.nearest[index] = own;
        // Neighbouring cells are updated when the obstacle has moved by a quarter of a cell.
        let quarters = |n: NearestObstacle| (n.x() >> 2, n.y() >> 2);
        if !was_own || quarters(own) != quarters(before) {
            self.nearest.insert(map, hit.cell, own);
        }
    }
}

/// Weight of a new hit in the mean of a cell at the upper clamp \[1\]. The mean covers about the last ten hits. Source: ours.
const MEAN_HIT_RATE: f64 = 0.1;

impl RayUpdateScratch {
    /// Computes the ends of the rays and the masks that cover them. Returns the origin of the rays, cells.
    fn find_ends(&mut self, pose: Pose2, scan: &ScanRays, is_blind: bool) -> (f64, f64) {
        let (s, c) = pose.theta.sin_cos();
        let put = |x: f32, y: f32| {
            let (x, y) = (f64::from(x), f64::from(y));
            (pose.x + c * x - s * y, pose.y + s * x + c * y)
        };
        let origin = put(scan.origin.0, scan.origin.1);
        self.ends.clear();
        let (mut low, mut high) = (origin, origin);
        for ray in &scan.rays {
            let (x, y) = put(ray.x, ray.y);
            low = (low.0.min(x), low.1.min(y));
            high = (high.0.max(x), high.1.max(y));
            self.ends.push(End {
                x,
                y,
                hit: ray.hit,
                joined: ray.joined,
                whole: ray.whole,
                weight: ray.hit_weight,
            });
        }
        // One extra cell: a cell of a ray may be next to the ray's end.
        let (low, high) = (cell_of(low), cell_of(high));
        let near = is_blind.then_some(&mut self.near);
        for mask in [&mut self.surface, &mut self.free].into_iter().chain(near) {
            mask.cover((low.0 - 1, low.1 - 1), (high.0 + 1, high.1 + 1));
        }
        origin
    }

    fn find_hits(&mut self) {
        self.hits.clear();
        for end in self.ends.iter().filter(|end| end.hit) {
            let cell = cell_of((end.x, end.y));
            if self.surface.set(cell.0, cell.1) {
                self.hits.push(HitCell { cell, sum: (end.x, end.y), count: 1.0, weight: end.weight });
            } else if let Some(hit) = self.hits.iter_mut().rev().find(|hit| hit.cell == cell) {
                hit.sum = (hit.sum.0 + end.x, hit.sum.1 + end.y);
                hit.count += 1.0;
                hit.weight = hit.weight.max(end.weight);
            }
        }
    }

    /// Marks the cells between two neighbouring hits of one surface. Grazing rays do not clear these cells.
    fn mark_surfaces(&mut self) {
        for pair in self.ends.windows(2).filter(|pair| pair[1].joined) {
            let mut ray = SteppedRay::new((pair[0].x, pair[0].y), (pair[1].x, pair[1].y));
            while ray.left > 0 {
                let (x, y) = ray.cell();
                self.surface.set(x, y);
                ray.advance();
            }
        }
    }
}

/// Stretch of a ray: origin and end of the ray, and the fractions at which the stretch begins and ends.
type Stretch = ((f64, f64), (f64, f64), f64, f64);

impl RayUpdateScratch {
    /// Marks the cells that the rays passed freely. `blind`: blind range about `origin`, cells.
    fn mark_free(&mut self, origin: (f64, f64), spans: &[RaySpan], blind: f64) {
        let mut spans = spans.iter().peekable();
        for (k, end) in self.ends.iter().enumerate() {
            let end_at = (end.x, end.y);
            let blind = if blind > 0.0 {
                blind / (end.x - origin.0).hypotenuse(end.y - origin.1).max(1e-9)
            } else {
                0.0
            };
            let mut stretch = |from: f64, to: f64| {
                if from < blind {
                    part((origin, end_at, from, to.min(blind))).mark(&mut self.near);
                }
                if to > blind {
                    part((origin, end_at, from.max(blind), to)).mark(&mut self.free);
                }
            };
            if end.whole {
                stretch(0.0, 1.0);
            }
            while let Some(span) = spans.next_if(|span| span.ray as usize == k) {
                stretch(f64::from(span.from), f64::from(span.to));
            }
        }
    }
}

fn part((origin, end, from, to): Stretch) -> SteppedRay {
    let at = |fraction: f64| match fraction {
        // The ends are returned unchanged, to the bit.
        0.0 => origin,
        1.0 => end,
        _ => (origin.0 + fraction * (end.0 - origin.0), origin.1 + fraction * (end.1 - origin.1)),
    };
    SteppedRay::new(at(from), at(to))
}

fn cell_of((x, y): (f64, f64)) -> (i32, i32) {
    (x.floor() as i32, y.floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::super::scan_rays::ScanRay;
    use super::*;
    use proptest::prelude::*;

    /// One ray along +x that ends `range_m` ahead, with free spans in m, in cells of 5 cm.
    fn ahead(range_m: f32, hit: bool, free_m: Option<&[(f32, f32)]>, hit_weight: f32) -> ScanRays {
        let ray =
            ScanRay { x: range_m / 0.05, y: 0.0, hit, joined: false, whole: free_m.is_none(), hit_weight };
        let span = |&(from, to): &(f32, f32)| RaySpan { ray: 0, from: from / range_m, to: to / range_m };
        ScanRays {
            rays: vec![ray],
            spans: free_m.iter().copied().flatten().map(span).collect(),
            ..ScanRays::default()
        }
    }

    fn apply(map: &mut TileMap, blind_range: f64, scan: &ScanRays) -> usize {
        let config = MapperConfig { blind_range, ..MapperConfig::default() };
        let update = RayUpdate::new(&config, NearestField::new(4, 2.0));
        update.apply(map, &mut RayUpdateScratch::default(), Pose2::new(0.5, 0.5, 0.0), scan)
    }

    fn log_odds(map: &TileMap, x: i32) -> i8 {
        map.tile(Tile::of_cell(x, 0)).log_odds[Tile::index(x, 0)]
    }

    #[test]
    fn only_free_stretches_are_cleared() {
        let mut map = TileMap::default();
        // Free from 0.5 to 1 m and from 2 m to the obstacle at 3 m: cells 10 to 20 and 40 to 59 of 5 cm.
        apply(&mut map, 0.0, &ahead(3.0, true, Some(&[(0.5, 1.0), (2.0, 3.0)]), 1.0));
        for (cells, sign) in [(0..10, 0), (11..20, -1), (22..40, 0), (41..60, -1), (60..61, 1), (61..70, 0)] {
            for x in cells {
                assert_eq!(log_odds(&map, x).signum(), sign, "cell {x}");
            }
        }
    }

    #[test]
    fn a_free_ray_clears_no_obstacle_in_the_blind_range() {
        let mut map = TileMap::default();
        let free = ahead(3.0, false, None, 1.0);
        apply(&mut map, 0.65, &ahead(0.4, true, None, 1.0));
        apply(&mut map, 0.65, &ahead(1.0, true, None, 1.0));
        for _ in 0..20 {
            apply(&mut map, 0.65, &free);
        }
        assert!(log_odds(&map, 8) > 0, "an obstacle below the field of view stays");
        assert!([5, 10, 20, 50].into_iter().all(|x| log_odds(&map, x) < 0));
        for _ in 0..20 {
            apply(&mut map, 0.0, &free);
        }
        assert!(log_odds(&map, 8) < 0);
    }

    #[test]
    fn a_hit_of_less_weight_raises_its_cell_less() {
        let rise = |weight: f32| {
            let mut map = TileMap::default();
            apply(&mut map, 0.0, &ahead(2.0, true, None, weight));
            log_odds(&map, 40)
        };
        assert!(rise(0.5) < rise(1.0) && rise(0.25) < rise(0.5) && rise(0.0) > 0);
    }

    proptest! {
        /// Each update changes a cell by at most one hit or one free ray, for any number of rays through it.
        #[test]
        fn a_cell_changes_once_a_scan_and_stays_within_the_clamps(
            ends in prop::collection::vec((-40.0..40.0_f32, -40.0..40.0_f32, any::<bool>()), 1..40),
            repeats in 1..12_usize,
        ) {
            let ray = |&(x, y, hit): &(f32, f32, bool)| {
                ScanRay { x, y, hit, joined: false, whole: true, hit_weight: 1.0 }
            };
            let scan = ScanRays { rays: ends.iter().map(ray).collect(), ..ScanRays::default() };
            let mut map = TileMap::default();
            let (hit, free, low, high) = (27, -13, -64, 112);
            for _ in 0..repeats {
                let before = map.clone();
                apply(&mut map, 0.0, &scan);
                for (x, y) in (-45..46).flat_map(|x| (-45..46).map(move |y| (x, y))) {
                    let value = |map: &TileMap| i32::from(map.tile(Tile::of_cell(x, y)).log_odds[Tile::index(x, y)]);
                    let (old, new) = (value(&before), value(&map));
                    let allowed = [old, (old + hit).min(high), (old + free).max(low)];
                    prop_assert!(allowed.contains(&new), "{old} became {new}");
                }
            }
        }
    }
}

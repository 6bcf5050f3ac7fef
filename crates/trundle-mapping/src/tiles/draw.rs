use super::{
    field::FieldModel,
    map::TileMap,
    mask::Mask,
    ray::Ray,
    tile::{LOG_ODDS_UNIT, Nearest, TILE_BITS, Tile},
    wipe::Wipe,
};
use crate::{
    MapperConfig,
    filter::{RaySpan, ScanShape},
};
use trundle_core::{Cell, Pose2};

/// How a scan changes a particle's map: the inverse sensor model in units of the tiles.
#[derive(Debug, Clone)]
pub(crate) struct Brush {
    hit: i8,
    high: i8,
    low: i8,
    wipe: Wipe,
    /// Nearer than this to their origin beams clear no obstacle, cells.
    blind: f64,
    pub(crate) field: FieldModel,
}

/// Buffers, kept from scan to scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct DrawScratch {
    /// Cells with hits, and surfaces between them: beams do not clear them.
    told: Mask,
    /// Cells that beams passed.
    free: Mask,
    /// The same in the blind range.
    near: Mask,
    ends: Vec<End>,
    hits: Vec<HitCell>,
    removed: Vec<(i32, i32)>,
}

/// Where a beam ends in the map, cells.
#[derive(Debug, Clone, Copy)]
struct End {
    x: f64,
    y: f64,
    hit: bool,
    joined: bool,
    whole: bool,
    sure: f32,
}

#[derive(Debug, Clone, Copy)]
struct HitCell {
    cell: (i32, i32),
    sum: (f64, f64),
    count: f64,
    sure: f32,
}

impl Brush {
    pub(crate) fn new(config: &MapperConfig, field: FieldModel) -> Self {
        let units = |log_odds: f64| (log_odds / LOG_ODDS_UNIT).round().clamp(1.0, 127.0) as i8;
        let (free, low) = (units(config.free), -units(config.clamp_low));
        // An obstacle is forgotten at these log-odds.
        let gone = (-2 * i16::from(free)).max(i16::from(low) + 1) as i8;
        Self {
            hit: units(config.hit),
            high: units(config.clamp_high),
            low,
            wipe: Wipe::new(free, low, gone),
            blind: config.blind_range / config.resolution,
            field,
        }
    }

    /// Draws a scan taken at `pose` (cells, rad): each cell is told once, a hit wins over passing freely. How many cells it
    /// told.
    pub(crate) fn draw(
        &self,
        map: &mut TileMap,
        scratch: &mut DrawScratch,
        pose: Pose2,
        scan: &ScanShape,
    ) -> usize {
        let origin = scratch.find_ends(pose, scan, self.blind > 0.0);
        if scratch.ends.is_empty() {
            return 0;
        }
        scratch.find_hits();
        scratch.mark_surfaces();
        scratch.mark_free(origin, &scan.spans, self.blind);
        let DrawScratch { told, free, near, hits, removed, .. } = scratch;
        removed.clear();
        let mut cells = hits.len() + self.wipe.wipe(map, (free, told), i8::MAX, removed);
        if self.blind > 0.0 {
            told.add(free);
            cells += self.wipe.wipe(map, (near, told), 0, removed);
        }
        if !removed.is_empty() {
            self.field.remove(map, removed);
        }
        for hit in hits.iter() {
            self.hit(map, hit);
        }
        cells
    }

    /// Sets a cell to what a finished map says of it.
    pub(crate) fn assert(&self, map: &mut TileMap, (x, y): (i32, i32), cell: Cell) {
        let log_odds = match cell {
            Cell::Unknown => return,
            Cell::Free => self.low,
            Cell::Occupied => self.high,
        };
        map.tile_mut((x >> TILE_BITS, y >> TILE_BITS)).log_odds[Tile::place(x, y)] = log_odds;
        if cell == Cell::Occupied {
            let own = Nearest::own(0, 0);
            map.tile_mut((x >> TILE_BITS, y >> TILE_BITS)).nearest[Tile::place(x, y)] = own;
            self.field.place(map, (x, y), own);
        }
    }

    /// Raises a cell; above "don't know" it is an obstacle at the mean of its hits.
    fn hit(&self, map: &mut TileMap, hit: &HitCell) {
        let (x, y) = hit.cell;
        let tile = map.tile_mut((x >> TILE_BITS, y >> TILE_BITS));
        let place = Tile::place(x, y);
        let old = tile.log_odds[place];
        let rise = (f32::from(self.hit) * hit.sure).round().max(1.0) as i8;
        let new = old.saturating_add(rise).min(self.high);
        tile.log_odds[place] = new;
        let before = tile.nearest[place];
        if new <= 0 {
            return;
        }
        let offset = |sum: f64, cell: i32| {
            ((sum / hit.count - f64::from(cell) - 0.5) * f64::from(Nearest::PER_CELL)).round() as i32
        };
        let there = (offset(hit.sum.0, x), offset(hit.sum.1, y));
        let was_own = before.is_own();
        let own = if was_own {
            let visits = f64::from(old.max(0)) / f64::from(self.hit);
            let rate = if old >= self.high { MEAN_RATE } else { 1.0 / (1.0 + visits) };
            let mean =
                |was: i8, is: i32| i32::from(was) + (f64::from(is - i32::from(was)) * rate).round() as i32;
            Nearest::own(mean(before.x(), there.0), mean(before.y(), there.1))
        } else {
            Nearest::own(there.0, there.1)
        };
        tile.nearest[place] = own;
        // Cells about it follow when it has moved by a quarter of a cell.
        let quarters = |n: Nearest| (n.x() >> 2, n.y() >> 2);
        if !was_own || quarters(own) != quarters(before) {
            self.field.place(map, hit.cell, own);
        }
    }
}

/// Weight of a new hit in the mean of a cell that is an obstacle for certain: about the last ten count.
const MEAN_RATE: f64 = 0.1;

impl DrawScratch {
    /// The ends of the beams, and a mask that holds them all; where the beams begin, cells.
    fn find_ends(&mut self, pose: Pose2, scan: &ScanShape, is_blind: bool) -> (f64, f64) {
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
            self.ends.push(End { x, y, hit: ray.hit, joined: ray.joined, whole: ray.whole, sure: ray.sure });
        }
        // One cell more: a ray's cells are found along its longer axis, and may lie beside its end.
        let (low, high) = (cell_of(low), cell_of(high));
        let near = is_blind.then_some(&mut self.near);
        for mask in [&mut self.told, &mut self.free].into_iter().chain(near) {
            mask.cover((low.0 - 1, low.1 - 1), (high.0 + 1, high.1 + 1));
        }
        origin
    }

    fn find_hits(&mut self) {
        self.hits.clear();
        for end in self.ends.iter().filter(|end| end.hit) {
            let cell = cell_of((end.x, end.y));
            if self.told.set(cell.0, cell.1) {
                self.hits.push(HitCell { cell, sum: (end.x, end.y), count: 1.0, sure: end.sure });
            } else if let Some(hit) = self.hits.iter_mut().rev().find(|hit| hit.cell == cell) {
                hit.sum = (hit.sum.0 + end.x, hit.sum.1 + end.y);
                hit.count += 1.0;
                hit.sure = hit.sure.max(end.sure);
            }
        }
    }

    /// Between two neighbouring hits goes a surface: beams that graze it do not clear it.
    fn mark_surfaces(&mut self) {
        for pair in self.ends.windows(2).filter(|pair| pair[1].joined) {
            let mut ray = Ray::new((pair[0].x, pair[0].y), (pair[1].x, pair[1].y));
            while ray.left > 0 {
                let (x, y) = ray.cell();
                self.told.set(x, y);
                ray.advance();
            }
        }
    }
}

/// A stretch of a beam: where it begins, where the beam would end, and from and to which parts of it.
type Stretch = ((f64, f64), (f64, f64), f64, f64);

impl DrawScratch {
    /// What the beams passed; `blind`: how near to `origin` they prove little, cells.
    fn mark_free(&mut self, origin: (f64, f64), spans: &[RaySpan], blind: f64) {
        let mut spans = spans.iter().peekable();
        for (k, end) in self.ends.iter().enumerate() {
            let end_at = (end.x, end.y);
            let blind =
                if blind > 0.0 { blind / (end.x - origin.0).hypot(end.y - origin.1).max(1e-9) } else { 0.0 };
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

fn part((origin, end, from, to): Stretch) -> Ray {
    let at = |part: f64| match part {
        // The ends as they are, to the bit.
        0.0 => origin,
        1.0 => end,
        _ => (origin.0 + part * (end.0 - origin.0), origin.1 + part * (end.1 - origin.1)),
    };
    Ray::new(at(from), at(to))
}

fn cell_of((x, y): (f64, f64)) -> (i32, i32) {
    (x.floor() as i32, y.floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filter::ParticleConfig;
    use trundle_core::{Beam, FreeSpan, Scan, ScanParts, Stamp, Vector2};

    fn ahead(beam: Beam, free: Option<Vec<FreeSpan>>, sigma: f32) -> Scan {
        let parts = ScanParts { beams: vec![beam], free, sigmas: vec![sigma], ..ScanParts::default() };
        Scan::from_parts(Stamp::default(), Vector2::zeros(), (0.0, 0.1), parts).unwrap()
    }

    fn draw(map: &mut TileMap, blind_range: f64, scan: &Scan) -> usize {
        let map_config = MapperConfig { blind_range, ..MapperConfig::default() };
        let config = ParticleConfig { map: map_config.clone(), ..ParticleConfig::default() };
        let mut shape = ScanShape::default();
        shape.set(&config, scan);
        let brush = Brush::new(&map_config, FieldModel::new(4, 2.0));
        brush.draw(map, &mut DrawScratch::default(), Pose2::new(0.5, 0.5, 0.0), &shape)
    }

    fn log_odds(map: &TileMap, x: i32) -> i8 {
        map.tile((x >> TILE_BITS, 0)).log_odds[Tile::place(x, 0)]
    }

    #[test]
    fn only_what_was_seen_to_be_free_is_cleared() {
        let mut map = TileMap::default();
        let span = |from, to| FreeSpan { beam: 0, from, to };
        // Free from 0.5 to 1 m and from 2 m to the obstacle at 3 m: cells 10 to 20 and 40 to 59 of 5 cm.
        let scan = ahead(Beam::Hit { range: 3.0 }, Some(vec![span(0.5, 1.0), span(2.0, 3.0)]), 0.01);
        draw(&mut map, 0.0, &scan);
        for (cells, says) in [(0..10, 0), (11..20, -1), (22..40, 0), (41..60, -1), (60..61, 1), (61..70, 0)] {
            for x in cells {
                assert_eq!(log_odds(&map, x).signum(), says, "cell {x}");
            }
        }
    }

    #[test]
    fn a_beam_clears_no_obstacle_in_the_blind_range() {
        let mut map = TileMap::default();
        let free = ahead(Beam::Free { range: 3.0 }, None, 0.0);
        draw(&mut map, 0.65, &ahead(Beam::Hit { range: 0.4 }, None, 0.01));
        draw(&mut map, 0.65, &ahead(Beam::Hit { range: 1.0 }, None, 0.01));
        for _ in 0..20 {
            draw(&mut map, 0.65, &free);
        }
        assert!(log_odds(&map, 8) > 0, "an obstacle that hides under the view stays");
        assert!(
            log_odds(&map, 5) < 0
                && log_odds(&map, 10) < 0
                && log_odds(&map, 20) < 0
                && log_odds(&map, 50) < 0
        );
        for _ in 0..20 {
            draw(&mut map, 0.0, &free);
        }
        assert!(log_odds(&map, 8) < 0);
    }

    #[test]
    fn a_far_hit_says_less_of_its_cell_than_a_near_one() {
        let rise = |sigma: f32| {
            let mut map = TileMap::default();
            draw(&mut map, 0.0, &ahead(Beam::Hit { range: 2.0 }, None, sigma));
            log_odds(&map, 40)
        };
        assert_eq!(rise(0.0), rise(0.025));
        assert!(rise(0.05) < rise(0.025) && rise(0.1) < rise(0.05) && rise(0.1) > 0);
    }
}

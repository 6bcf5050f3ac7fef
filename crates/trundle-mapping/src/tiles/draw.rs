use super::{
    field::FieldModel,
    map::TileMap,
    mask::{self, Mask},
    tile::{LOG_ODDS_UNIT, Nearest, TILE_BITS, TILE_SIDE, Tile},
};
use crate::{MapperConfig, filter::ScanShape};
use trundle_core::{Cell, Pose2};

/// How a scan changes a particle's map: the inverse sensor model in units of the tiles.
#[derive(Debug, Clone)]
pub(crate) struct Brush {
    hit: i8,
    free: i8,
    high: i8,
    low: i8,
    /// An obstacle is forgotten at these log-odds.
    gone: i8,
    pub(crate) field: FieldModel,
}

/// What drawing a scan found.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Drawn {
    /// Cells with hits.
    pub(crate) hits: usize,
    /// Cells passed freely.
    pub(crate) frees: usize,
    /// Beams that passed through what was a wall for certain.
    pub(crate) contradictions: usize,
}

/// Buffers, kept from scan to scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct DrawScratch {
    mask: Mask,
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
}

#[derive(Debug, Clone, Copy)]
struct HitCell {
    cell: (i32, i32),
    sum: (f64, f64),
    count: f64,
}

/// What the rays of a scan did on their way.
struct Cleared<'a> {
    mask: &'a mut Mask,
    removed: &'a mut Vec<(i32, i32)>,
    frees: usize,
}

/// A beam that meets a cell of two hits more than this many cells before its end passes through a wall.
const WALL_MARGIN: i64 = 4;

impl Brush {
    pub(crate) fn new(config: &MapperConfig, field: FieldModel) -> Self {
        let units = |log_odds: f64| (log_odds / LOG_ODDS_UNIT).round().clamp(1.0, 127.0) as i8;
        Self {
            hit: units(config.hit),
            free: units(config.free),
            high: units(config.clamp_high),
            low: -units(config.clamp_low),
            gone: (-2 * i16::from(units(config.free))).max(-i16::from(units(config.clamp_low)) + 1) as i8,
            field,
        }
    }

    /// Draws a scan taken at `pose` (cells, rad): each cell is told once, a hit wins over passing freely.
    pub(crate) fn draw(
        &self,
        map: &mut TileMap,
        scratch: &mut DrawScratch,
        pose: Pose2,
        scan: &ScanShape,
    ) -> Drawn {
        let origin = scratch.find_ends(pose, scan);
        if scratch.ends.is_empty() {
            return Drawn::default();
        }
        scratch.find_hits();
        scratch.mark_surfaces();
        let mut drawn = Drawn { hits: scratch.hits.len(), ..Drawn::default() };
        let DrawScratch { mask, ends, hits, removed } = scratch;
        removed.clear();
        let mut cleared = Cleared { mask, removed, frees: 0 };
        for end in ends.iter() {
            let solid = self.clear(map, &mut cleared, Ray::new(origin, (end.x, end.y)));
            drawn.contradictions += usize::from(solid);
        }
        drawn.frees = cleared.frees;
        if !removed.is_empty() {
            self.field.remove(map, removed);
        }
        for hit in hits.iter() {
            self.hit(map, hit);
        }
        drawn
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

    /// Lowers the cells of a ray; whether it passed through a wall.
    fn clear(&self, map: &mut TileMap, scratch: &mut Cleared<'_>, ray: Ray) -> bool {
        if ray.steep {
            self.clear_along::<true>(map, scratch, ray)
        } else {
            self.clear_along::<false>(map, scratch, ray)
        }
    }

    fn clear_along<const STEEP: bool>(
        &self,
        map: &mut TileMap,
        cleared: &mut Cleared<'_>,
        mut ray: Ray,
    ) -> bool {
        let (free, low, wall) = (i16::from(self.free), i16::from(self.low), self.hit.saturating_mul(2));
        let mut solid = false;
        while ray.left > 0 {
            let tile_at = ray.tile();
            let tile = map.tile_mut(tile_at);
            let mask = cleared.mask.tile(tile_at);
            let minor_tile = (ray.minor >> 32) as i32 >> TILE_BITS;
            let (mut major, mut minor, mut steps) = (ray.major, ray.minor, 0);
            for _ in 0..ray.steps_in_tile() {
                let at = (minor >> 32) as i32;
                if at >> TILE_BITS != minor_tile {
                    break;
                }
                let (x, y) = if STEEP { (at, major) } else { (major, at) };
                major += ray.step;
                minor += ray.slope;
                steps += 1;
                if !mask::set(mask, x, y) {
                    continue;
                }
                let place = Tile::place(x, y);
                let old = tile.log_odds[place];
                let new = (i16::from(old) - free).max(low) as i8;
                tile.log_odds[place] = new;
                cleared.frees += 1;
                if old > self.gone {
                    solid |= old >= wall && ray.left - steps > WALL_MARGIN;
                    if new <= self.gone && tile.nearest[place].is_own() {
                        cleared.removed.push((x, y));
                    }
                }
            }
            (ray.major, ray.minor, ray.left) = (major, minor, ray.left - steps);
        }
        solid
    }

    /// Raises a cell; above "don't know" it is an obstacle at the mean of its hits.
    fn hit(&self, map: &mut TileMap, hit: &HitCell) {
        let (x, y) = hit.cell;
        let tile = map.tile_mut((x >> TILE_BITS, y >> TILE_BITS));
        let place = Tile::place(x, y);
        let old = tile.log_odds[place];
        let new = old.saturating_add(self.hit).min(self.high);
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
            let rate = (1.0 / (1.0 + visits)).max(MEAN_RATE);
            let mean =
                |was: i8, is: i32| i32::from(was) + (f64::from(is - i32::from(was)) * rate).round() as i32;
            Nearest::own(mean(before.x, there.0), mean(before.y, there.1))
        } else {
            Nearest::own(there.0, there.1)
        };
        tile.nearest[place] = own;
        // Cells about it follow when it has moved by an eighth of a cell.
        let eighths = |n: Nearest| (n.x >> 1, n.y >> 1);
        if !was_own || eighths(own) != eighths(before) {
            self.field.place(map, hit.cell, own);
        }
    }
}

/// Least weight of a new hit in the mean of its cell: about the last eight count.
const MEAN_RATE: f64 = 0.125;

impl DrawScratch {
    /// The ends of the beams, and a mask that holds them all; where the beams begin, cells.
    fn find_ends(&mut self, pose: Pose2, scan: &ScanShape) -> (f64, f64) {
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
            self.ends.push(End { x, y, hit: ray.hit, joined: ray.joined });
        }
        // One cell more: a ray's cells are found along its longer axis, and may lie beside its end.
        let (low, high) = (cell_of(low), cell_of(high));
        self.mask.cover((low.0 - 1, low.1 - 1), (high.0 + 1, high.1 + 1));
        origin
    }

    fn find_hits(&mut self) {
        self.hits.clear();
        for end in self.ends.iter().filter(|end| end.hit) {
            let cell = cell_of((end.x, end.y));
            if self.mask.set(cell.0, cell.1) {
                self.hits.push(HitCell { cell, sum: (end.x, end.y), count: 1.0 });
            } else if let Some(hit) = self.hits.iter_mut().rev().find(|hit| hit.cell == cell) {
                hit.sum = (hit.sum.0 + end.x, hit.sum.1 + end.y);
                hit.count += 1.0;
            }
        }
    }

    /// Between two neighbouring hits goes a surface: beams that graze it do not clear it.
    fn mark_surfaces(&mut self) {
        for pair in self.ends.windows(2).filter(|pair| pair[1].joined) {
            let mut ray = Ray::new((pair[0].x, pair[0].y), (pair[1].x, pair[1].y));
            while ray.left > 0 {
                let (x, y) = ray.cell();
                self.mask.set(x, y);
                ray.advance();
            }
        }
    }
}

fn cell_of((x, y): (f64, f64)) -> (i32, i32) {
    (x.floor() as i32, y.floor() as i32)
}

/// The cells from a point up to, but without, the cell of another: one for each step along the longer axis, the one
/// that the line passes at the middle of that column or row.
#[derive(Debug, Clone, Copy)]
struct Ray {
    major: i32,
    /// 32.32 fixed point.
    minor: i64,
    step: i32,
    slope: i64,
    steep: bool,
    left: i64,
}

impl Ray {
    fn new(from: (f64, f64), to: (f64, f64)) -> Self {
        const ONE: f64 = 4_294_967_296.0;
        let steep = (to.1 - from.1).abs() > (to.0 - from.0).abs();
        let along = |p: (f64, f64)| if steep { (p.1, p.0) } else { p };
        let ((a0, b0), (a1, b1)) = (along(from), along(to));
        let (start, end) = (a0.floor(), a1.floor());
        let sign = if a1 >= a0 { 1.0 } else { -1.0 };
        let slope = if a1 == a0 { 0.0 } else { (b1 - b0) / (a1 - a0).abs() };
        let to_middle = (start + 0.5 - a0) * sign;
        Self {
            major: start as i32,
            minor: ((b0 + slope * to_middle) * ONE) as i64,
            step: sign as i32,
            slope: (slope * ONE) as i64,
            steep,
            left: (end - start).abs() as i64,
        }
    }

    #[inline]
    fn cell(&self) -> (i32, i32) {
        let minor = (self.minor >> 32) as i32;
        if self.steep { (minor, self.major) } else { (self.major, minor) }
    }

    /// How many steps there are until the longer axis leaves its tile, or the ray ends.
    #[inline]
    fn steps_in_tile(&self) -> i64 {
        const MASK: i32 = TILE_SIDE as i32 - 1;
        let within = self.major & MASK;
        self.left.min(i64::from(if self.step > 0 { MASK - within + 1 } else { within + 1 }))
    }

    #[inline]
    fn tile(&self) -> (i32, i32) {
        let (x, y) = self.cell();
        (x >> TILE_BITS, y >> TILE_BITS)
    }

    #[inline]
    fn advance(&mut self) {
        self.major += self.step;
        self.minor += self.slope;
        self.left -= 1;
    }
}

//! Things that move, found in successive scans.
//!
//! Problem: a scan says where something stands, not that it walks. Idea: scans are drawn into a grid about the robot, at each of
//! its cells when it was last seen free and since when it has been hit. A hit where it was free a moment ago is part of something
//! that came; such hits, near each other, are a cluster, taken for the near side of a disc. Clusters are tied to tracks by where
//! those are expected; a straight line through a track's last places, by least squares, is its velocity; it counts as moving once
//! it has left the place where it was first seen. Cost: O(beams x reach / cell) a scan.
//!
//! What was never seen free is not new: a wall that comes into view is no mover. What stops may go on any moment, for 10 s. What came to
//! where the sensor is blind, near by, and was not seen to leave stands there for up to 10 s.

mod cluster;
mod config;
mod seen;
mod track;

pub use config::TrackerConfig;

use crate::Mover;
use cluster::{Cluster, clusters};
use seen::{SIDE, SeenCells};
use track::{HIDES, Track};
use trundle_core::{Beam, Cell, CellIndex, Invalid, OccupancyGrid, Pose2, Scan, Stamp, Vector2};

/// Beams are believed to be free up to so far before what they hit, m: pose and range are not exact.
const SHORT: f64 = 0.1;
/// Stretches between two beams that are filled at the most.
const MOST_BETWEEN: f64 = 8.0;

/// Finds movers in successive scans.
#[derive(Debug)]
pub struct MoverTracker {
    config: TrackerConfig,
    cells: SeenCells,
    /// Of the first scan; times are seconds since.
    begin: Option<Stamp>,
    time: f64,
    /// Where the sensor was then, map frame.
    sensor: Vector2,
    tracks: Vec<Track>,
    /// Hits of a scan within reach, map frame; kept for its memory.
    hits: Vec<Vector2>,
}

impl MoverTracker {
    /// A tracker that has seen nothing.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub fn new(config: TrackerConfig) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let cells = SeenCells::new(config.reach, config.memory);
        Ok(Self {
            config,
            cells,
            begin: None,
            time: f64::NEG_INFINITY,
            sensor: Vector2::zeros(),
            tracks: vec![],
            hits: vec![],
        })
    }

    /// Takes in a scan, made where the base was at `map_from_base`. One that is not later than the last one is ignored, and so
    /// is one from nowhere (NaN). One that is 10 s older says that the clock was set back: all is forgotten.
    pub fn see(&mut self, map_from_base: Pose2, scan: &Scan) {
        let is_somewhere = [map_from_base.x, map_from_base.y, map_from_base.theta].into_iter().all(is_place);
        if !is_somewhere {
            return;
        }
        if self.seconds(scan.stamp()) < self.time - HIDES {
            self.forget();
            (self.begin, self.time) = (None, f64::NEG_INFINITY);
        }
        let time = scan.stamp() - *self.begin.get_or_insert(scan.stamp());
        if time <= self.time {
            return;
        }
        self.time = time;
        self.sensor = map_from_base.transform(scan.origin());
        self.note_hits(map_from_base, scan);
        self.note_free(map_from_base, self.sensor, scan);
        let new: Vec<Vector2> =
            self.hits.iter().copied().filter(|hit| self.cells.has_come(*hit, time)).collect();
        let mut found = clusters(&new, self.sensor, self.config.gap);
        found.retain(|cluster| self.may_move(cluster));
        self.follow(found);
    }

    /// Forgets all that was seen: the robot is not where it believed, and what stood seems to have moved.
    pub fn forget(&mut self) {
        self.cells = SeenCells::new(self.config.reach, self.config.memory);
        self.tracks.clear();
    }

    /// Seconds since the first scan.
    fn seconds(&self, stamp: Stamp) -> f64 {
        self.begin.map_or(0.0, |begin| stamp - begin)
    }

    /// What moves, at its places at `now`: not long after the last scan. Who walked within the last 10 s and stopped may go on as before
    /// any moment: their way of the next 2 s is taken by discs that stand, so that whoever passes goes behind, or waits.
    pub fn movers(&self, now: Stamp) -> Vec<Mover> {
        let now = self.seconds(now);
        let moving = self.moving().map(|track| track.mover(now, &self.config));
        let stopped =
            self.tracks.iter().flat_map(|track| track.way_on(now, self.sensor, &self.cells, &self.config));
        let mover = |(at, velocity, radius)| Mover::new(at, velocity, radius + SIDE / 2.0).ok();
        moving.chain(stopped).filter_map(mover).collect()
    }

    /// Hits within `reach` m of a place, map frame, and of the reach of the scans: of what came while it was watched, was last seen there
    /// at most 10 s before `now`, and has not been seen to go, whether it is in sight or where the sensor is blind. A map takes longer
    /// to believe in it. None about a place that is none.
    pub fn not_gone(&self, now: Stamp, near: Vector2, reach: f64) -> Vec<Vector2> {
        if !near.iter().all(|n| is_place(*n)) || reach.is_nan() {
            return Vec::new();
        }
        self.cells.not_gone(near, reach.min(self.config.reach), self.seconds(now) - HIDES)
    }

    /// The grid without what moves, and without what it left behind where it has been seen to be free since: a plan among movers
    /// must not take them for walls.
    pub fn without_movers(&self, grid: &OccupancyGrid) -> OccupancyGrid {
        let mut still = grid.clone();
        for track in self.moving() {
            let (at, _, radius) = track.mover(self.time, &self.config);
            let now = (at, radius);
            clear(&mut still, now, |at| self.cells.is_open(at, self.time));
            track.trail(&self.config).for_each(|disc| clear(&mut still, disc, |at| self.cells.is_left(at)));
        }
        still
    }

    fn may_move(&self, cluster: &Cluster) -> bool {
        cluster.hits.len() >= self.config.least_hits
            && cluster.radius <= self.config.largest
            && !cluster.hits.iter().any(|hit| self.cells.has_settled(*hit, self.time))
    }

    fn moving(&self) -> impl Iterator<Item = &Track> {
        self.tracks.iter().filter(|track| track.is_hidden() || track.moves(&self.cells, &self.config))
    }

    fn note_hits(&mut self, map_from_base: Pose2, scan: &Scan) {
        self.hits.clear();
        for (i, beam) in scan.beams().iter().enumerate() {
            if let Beam::Hit { range } = beam
                && *range <= self.config.reach
            {
                let hit = map_from_base.transform(scan.point(i, *range));
                self.cells.hit(hit, self.time);
                self.hits.push(hit);
            }
        }
    }

    /// What beams passed. Where they are close together every second, fourth, ... is enough; where they are far apart, what both
    /// neighbours passed is free between them too.
    fn note_free(&mut self, map_from_base: Pose2, sensor: Vector2, scan: &Scan) {
        let step = scan.angle_increment();
        let between = (self.config.reach * step / SIDE).ceil().clamp(1.0, MOST_BETWEEN) as usize;
        for i in 0..scan.beams().len() {
            let along = |part: f64| {
                let angle = map_from_base.theta + scan.angle(i) + part * step;
                Vector2::new(angle.cos(), angle.sin())
            };
            // Nearer than this the beams i +- 2^k with more zeros lie within a cell's side of each other.
            let apart = step * (1_u64 << (i | 1 << 16).trailing_zeros()) as f64;
            let near = if between == 1 { SIDE / (4.0 * apart) } else { 0.0 };
            let end = self.passed(scan, i);
            for (from, to) in scan.free_spans(i) {
                self.carve(sensor, along(0.0), (from.max(near), to.min(end)));
                let shared = to.min(end).min(self.passed(scan, i + 1));
                for k in 1..between {
                    self.carve(sensor, along(k as f64 / between as f64), (from, shared));
                }
            }
        }
    }

    /// How far a beam surely passed, m; 0 where there is none.
    fn passed(&self, scan: &Scan, i: usize) -> f64 {
        let end = match scan.beams().get(i) {
            Some(Beam::Hit { range }) => range - SHORT,
            Some(Beam::Free { range }) => *range,
            Some(Beam::Unseen) => f64::INFINITY,
            None => 0.0,
        };
        end.min(self.config.reach)
    }

    fn carve(&mut self, sensor: Vector2, along: Vector2, (from, to): (f64, f64)) {
        let steps = ((to - from) / SIDE).max(-1.0).floor();
        for step in 0..(steps + 1.0) as usize {
            self.cells.free(sensor + along * (from + step as f64 * SIDE), self.time);
        }
    }

    /// Ties clusters to tracks, nearest first, and to those in sight before those that hide; the rest begin tracks of their own. Tracks not seen for a window end, but for those
    /// that went to where the sensor is blind, and those that stopped and were not seen to leave.
    fn follow(&mut self, clusters: Vec<Cluster>) {
        let (time, sensor, config) = (self.time, self.sensor, self.config);
        let mut pairs = Vec::new();
        for (t, track) in self.tracks.iter().enumerate() {
            for (c, cluster) in clusters.iter().enumerate() {
                let off = track.gap(time, cluster.middle, &config);
                if off <= config.gate {
                    pairs.push((track.is_hidden() || track.is_lost(time, &config), off, t, c));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then((a.2, a.3).cmp(&(b.2, b.3))));
        let mut clusters: Vec<Option<Cluster>> = clusters.into_iter().map(Some).collect();
        let mut found = vec![false; self.tracks.len()];
        for (.., t, c) in pairs {
            if !found[t]
                && let Some(cluster) = clusters[c].take()
            {
                found[t] = true;
                self.tracks[t].add(time, cluster, &config);
            }
        }
        let cells = &self.cells;
        self.tracks.retain_mut(|track| track.lasts(time, sensor, cells, &config));
        self.tracks.extend(clusters.into_iter().flatten().map(|cluster| Track::new(time, cluster)));
    }
}

/// Whether a coordinate of a map, m, or a heading can be one.
fn is_place(coordinate: f64) -> bool {
    coordinate.abs() < 1e6
}

/// Frees what is occupied in a disc, where `may` says so of a cell's centre.
fn clear(grid: &mut OccupancyGrid, (middle, radius): (Vector2, f64), may: impl Fn(Vector2) -> bool) {
    let geometry = *grid.geometry();
    // A cell more: the map draws what it sees into the cells that hold it.
    let reach = radius + geometry.resolution * std::f64::consts::SQRT_2;
    let index =
        |at: f64, size: usize| (at / geometry.resolution).floor().clamp(0.0, size as f64 - 1.0) as usize;
    let (low, high) = (
        middle - geometry.origin - Vector2::repeat(reach),
        middle - geometry.origin + Vector2::repeat(reach),
    );
    for row in index(low.y, geometry.height)..=index(high.y, geometry.height) {
        for col in index(low.x, geometry.width)..=index(high.x, geometry.width) {
            let cell = CellIndex { col, row };
            let centre = geometry.center(cell);
            let is_inside = (centre - middle).norm() <= reach;
            if is_inside && grid.get(cell) == Cell::Occupied && may(centre) {
                grid.set(cell, Cell::Free);
            }
        }
    }
}

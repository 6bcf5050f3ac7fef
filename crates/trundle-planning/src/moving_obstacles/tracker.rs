//! Moving obstacles in successive scans.
//!
//! Problem: a scan shows the position of an object, but not its motion. Idea: a grid around the robot stores for each cell the last time it
//! was free, and the time since which it is hit. A hit in a recently free cell belongs to an object that arrived. Such hits, near each
//! other, form a cluster, the near side of a disc. Clusters are associated with tracks by their expected positions. The velocity of a track
//! is a least-squares line through its last positions. A track moves if it has left the position of its first observation. Cost: O(beams x
//! reach
//! / cell) per scan.
//!
//! A cell that was never observed free is not new: a wall that comes into view does not move. An object that stops may move on for 10 s. An
//! object that arrived in the sensor's blind zone counts as present for up to 10 s unless observed to leave.

use crate::moving_obstacles::cell_history::{CELL_SIDE_M, CellHistory};
use crate::moving_obstacles::cluster::{Cluster, clusters};
use crate::moving_obstacles::config::ObstacleTrackerConfig;
use crate::moving_obstacles::forecast::MovingObstacle;
use crate::moving_obstacles::track::{MAX_HIDDEN_S, Track};
use trundle_core::{Beam, Cell, CellIndex, Invalid, OccupancyGrid, Pose2, Scan, Stamp, Vector2};

/// Length at the end of a beam that does not count as free, m: pose and range are not exact. Source: ours.
const UNCERTAIN_END_M: f64 = 0.1;
/// Largest number of interpolated rays between two beams. Source: ours.
const MAX_RAYS_BETWEEN: f64 = 8.0;

/// Detects and tracks moving obstacles in successive scans.
#[derive(Debug)]
pub struct MovingObstacleTracker {
    config: ObstacleTrackerConfig,
    cells: CellHistory,
    /// Stamp of the first scan; times are seconds since.
    begin: Option<Stamp>,
    time: f64,
    /// Position of the sensor at the last scan, map frame.
    sensor: Vector2,
    tracks: Vec<Track>,
    /// Hits of a scan within reach, map frame; the buffer is reused.
    hits: Vec<Vector2>,
}

impl MovingObstacleTracker {
    /// A tracker without observations.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub fn new(config: ObstacleTrackerConfig) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let cells = CellHistory::new(config.reach, config.memory);
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

    /// Adds a scan taken at the base pose `map_from_base`. A scan that is not later than the last one is ignored, and so is a pose
    /// that is not finite. A scan that is 10 s older means that the clock was set back: the tracker is cleared.
    pub fn add_scan(&mut self, map_from_base: Pose2, scan: &Scan) {
        let is_somewhere =
            [map_from_base.x, map_from_base.y, map_from_base.theta].into_iter().all(is_coordinate);
        if !is_somewhere {
            return;
        }
        if self.seconds(scan.stamp()) < self.time - MAX_HIDDEN_S {
            self.clear();
            (self.begin, self.time) = (None, f64::NEG_INFINITY);
        }
        let time = scan.stamp() - *self.begin.get_or_insert(scan.stamp());
        if time <= self.time {
            return;
        }
        self.time = time;
        self.sensor = map_from_base.transform(scan.origin());
        self.add_hits(map_from_base, scan);
        self.add_free(map_from_base, self.sensor, scan);
        let new: Vec<Vector2> =
            self.hits.iter().copied().filter(|hit| self.cells.has_arrived(*hit, time)).collect();
        let mut found = clusters(&new, self.sensor, self.config.gap);
        found.retain(|cluster| self.may_move(cluster));
        self.associate(found);
    }

    /// Clears all observations: after a jump of the pose, static objects seem to have moved.
    pub fn clear(&mut self) {
        self.cells = CellHistory::new(self.config.reach, self.config.memory);
        self.tracks.clear();
    }

    /// Seconds since the first scan.
    fn seconds(&self, stamp: Stamp) -> f64 {
        self.begin.map_or(0.0, |begin| stamp - begin)
    }

    /// Moving obstacles at `now`, a short time after the last scan. A person who walked within the last 10 s and stopped may continue:
    /// discs at rest cover the path of the next 2 s. Plans then pass behind the person, or wait.
    pub fn moving_obstacles(&self, now: Stamp) -> Vec<MovingObstacle> {
        let now = self.seconds(now);
        let moving = self.moving().map(|track| track.state_at(now, &self.config));
        let stopped = self
            .tracks
            .iter()
            .flat_map(|track| track.possible_path(now, self.sensor, &self.cells, &self.config));
        let obstacle =
            |(at, velocity, radius)| MovingObstacle::new(at, velocity, radius + CELL_SIDE_M / 2.0).ok();
        moving.chain(stopped).filter_map(obstacle).collect()
    }

    /// Hits within `reach` m of a point, map frame, that may still be occupied. They come from objects that arrived during observation,
    /// were last observed at most 10 s before `now`, and were not observed to leave, in view or in the blind zone. The map shows such
    /// objects only later. Empty for a point that is not finite.
    pub fn unconfirmed_hits(&self, now: Stamp, near: Vector2, reach: f64) -> Vec<Vector2> {
        if !near.iter().all(|n| is_coordinate(*n)) || reach.is_nan() {
            return Vec::new();
        }
        self.cells.unconfirmed_hits(near, reach.min(self.config.reach), self.seconds(now) - MAX_HIDDEN_S)
    }

    /// The grid without moving obstacles, and without the cells that they left and that were observed free since then. A plan among moving
    /// obstacles must not treat these cells as walls.
    pub fn static_grid(&self, grid: &OccupancyGrid) -> OccupancyGrid {
        let mut still = grid.clone();
        for track in self.moving() {
            let (at, _, radius) = track.state_at(self.time, &self.config);
            let now = (at, radius);
            free_disc(&mut still, now, |at| self.cells.is_open(at, self.time));
            track
                .trail(&self.config)
                .for_each(|disc| free_disc(&mut still, disc, |at| self.cells.is_left(at)));
        }
        still
    }

    fn may_move(&self, cluster: &Cluster) -> bool {
        cluster.hits.len() >= self.config.min_hits
            && cluster.radius <= self.config.largest
            && !cluster.hits.iter().any(|hit| self.cells.is_part_of_static(*hit, self.time))
    }

    fn moving(&self) -> impl Iterator<Item = &Track> {
        self.tracks.iter().filter(|track| track.is_hidden() || track.moves(&self.cells, &self.config))
    }

    fn add_hits(&mut self, map_from_base: Pose2, scan: &Scan) {
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

    /// Marks the cells that beams passed. Near the sensor every second, fourth, ... beam is enough. Between distant neighbouring beams, the
    /// range passed by both counts as free.
    fn add_free(&mut self, map_from_base: Pose2, sensor: Vector2, scan: &Scan) {
        let step = scan.angle_increment();
        let between = (self.config.reach * step / CELL_SIDE_M).ceil().clamp(1.0, MAX_RAYS_BETWEEN) as usize;
        for i in 0..scan.beams().len() {
            let along = |part: f64| {
                let angle = map_from_base.theta + scan.angle(i) + part * step;
                Vector2::new(angle.cos(), angle.sin())
            };
            // At smaller ranges the beams i +- 2^k with more zeros are within a cell's side of each other.
            let apart = step * (1_u64 << (i | 1 << 16).trailing_zeros()) as f64;
            let near = if between == 1 { CELL_SIDE_M / (4.0 * apart) } else { 0.0 };
            let end = self.passed(scan, i);
            for (from, to) in scan.free_spans(i) {
                self.add_free_ray(sensor, along(0.0), (from.max(near), to.min(end)));
                let shared = to.min(end).min(self.passed(scan, i + 1));
                for k in 1..between {
                    self.add_free_ray(sensor, along(k as f64 / between as f64), (from, shared));
                }
            }
        }
    }

    /// Range that a beam certainly passed, m; 0 without a beam.
    fn passed(&self, scan: &Scan, i: usize) -> f64 {
        let end = match scan.beams().get(i) {
            Some(Beam::Hit { range }) => range - UNCERTAIN_END_M,
            Some(Beam::Free { range }) => *range,
            Some(Beam::Unseen) => f64::INFINITY,
            None => 0.0,
        };
        end.min(self.config.reach)
    }

    fn add_free_ray(&mut self, sensor: Vector2, along: Vector2, (from, to): (f64, f64)) {
        let steps = ((to - from) / CELL_SIDE_M).max(-1.0).floor();
        for step in 0..(steps + 1.0) as usize {
            self.cells.free(sensor + along * (from + step as f64 * CELL_SIDE_M), self.time);
        }
    }

    /// Associates clusters with tracks, nearest first, visible tracks before hidden ones; remaining clusters start tracks. Tracks without
    /// an observation for a window end, except those in the blind zone and stopped ones that were not observed to leave.
    fn associate(&mut self, clusters: Vec<Cluster>) {
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
        self.tracks.retain_mut(|track| track.is_kept(time, sensor, cells, &config));
        self.tracks.extend(clusters.into_iter().flatten().map(|cluster| Track::new(time, cluster)));
    }
}

/// Whether a number can be a coordinate of a map, m, or a heading, rad.
fn is_coordinate(coordinate: f64) -> bool {
    coordinate.abs() < 1e6
}

/// Frees the occupied cells of a disc for which `may` accepts the cell's centre.
fn free_disc(grid: &mut OccupancyGrid, (middle, radius): (Vector2, f64), may: impl Fn(Vector2) -> bool) {
    let geometry = *grid.geometry();
    // The radius has one extra cell: the map marks the cells that contain the hits.
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

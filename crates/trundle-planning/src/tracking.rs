//! Things that move, found in successive grids.
//!
//! Problem: a grid says where something stands, not that it walks. Idea: a cell that is occupied and was seen free a moment ago
//! is part of something that came; such cells, connected, are a cluster. Clusters are tied to tracks by where those are
//! expected; a straight line through a track's last places, by least squares, is its velocity; it counts as moving once it
//! has left the cells where it was first seen, which are free again. Cost: O(cells) a grid.
//!
//! What was unknown before is not new: a wall that comes into view is no mover. What stops becomes part of the map after
//! `memory` seconds.

use crate::Mover;
use serde::{Deserialize, Serialize};
use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, Vector2, require_in};

/// How movers are found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrackerConfig {
    /// How long ago an occupied cell may have been seen free to count as newly occupied, s, 0.1 to 60. Default 3 (ours): at 0.2 m/s
    /// all of a person (0.6 m) is new.
    pub memory: f64,
    /// Cells of a cluster below which it is noise, 1 to 10000. Default 3 (ours).
    pub least_cells: usize,
    /// Radius above which a cluster is a change of the map, not a mover, m, 0.05 to 10. Default 1 (ours).
    pub largest: f64,
    /// How far from where it is expected a cluster may be taken for a track, m, 0.05 to 10. Default 0.5 (ours).
    pub gate: f64,
    /// Time over which a velocity is fitted, s, 0.1 to 10. Default 1 (ours).
    pub window: f64,
    /// Speed below which a thing counts as standing, m/s, 0.01 to 10. Default 0.1 (ours).
    pub least_speed: f64,
    /// Sightings before a track is believed, 2 to 1000. Default 4 (ours).
    pub sightings: usize,
}

impl Default for TrackerConfig {
    fn default() -> Self {
        Self {
            memory: 3.0,
            least_cells: 3,
            largest: 1.0,
            gate: 0.5,
            window: 1.0,
            least_speed: 0.1,
            sightings: 4,
        }
    }
}

impl TrackerConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("tracker.memory", self.memory, "s", 0.1, 60.0)?;
        require_in("tracker.least_cells", self.least_cells as f64, "cells", 1.0, 1e4)?;
        require_in("tracker.largest", self.largest, "m", 0.05, 10.0)?;
        require_in("tracker.gate", self.gate, "m", 0.05, 10.0)?;
        require_in("tracker.window", self.window, "s", 0.1, 10.0)?;
        require_in("tracker.least_speed", self.least_speed, "m/s", 0.01, 10.0)?;
        require_in("tracker.sightings", self.sightings as f64, "", 2.0, 1e3)?;
        Ok(self)
    }
}

/// Finds movers in successive grids.
#[derive(Debug)]
pub struct MoverTracker {
    config: TrackerConfig,
    geometry: Option<GridGeometry>,
    /// When each cell was last seen free, s.
    free_at: Vec<f64>,
    time: f64,
    tracks: Vec<Track>,
}

/// Cells that came together.
struct Cluster {
    centres: Vec<Vector2>,
    middle: Vector2,
    radius: f64,
}

#[derive(Debug)]
struct Track {
    /// Where its cells were when it was first seen.
    first: Vec<Vector2>,
    /// Its cells now.
    cells: Vec<Vector2>,
    /// Times and places, oldest first, not older than the window.
    seen: Vec<(f64, Vector2)>,
    sightings: usize,
    radius: f64,
    velocity: Vector2,
}

impl Track {
    fn expected(&self, time: f64) -> Vector2 {
        let (last, at) = self.seen[self.seen.len() - 1];
        at + self.velocity * (time - last)
    }

    fn add(&mut self, time: f64, cluster: Cluster, window: f64) {
        self.seen.push((time, cluster.middle));
        self.seen.retain(|(at, _)| time - at <= window);
        self.sightings += 1;
        self.radius = self.radius.max(cluster.radius);
        self.cells = cluster.centres;
        self.velocity = velocity(&self.seen);
    }
}

impl MoverTracker {
    /// A tracker that has seen nothing.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub fn new(config: TrackerConfig) -> Result<Self, Invalid> {
        let config = config.validated()?;
        Ok(Self { config, geometry: None, free_at: vec![], time: f64::NEG_INFINITY, tracks: vec![] })
    }

    /// Looks at the grid as it is at `time` (s): what moves, at its place now. Grids may grow and shift between looks; a time
    /// that is not later than the last one is ignored.
    pub fn look(&mut self, time: f64, grid: &OccupancyGrid) -> Vec<Mover> {
        if time.is_finite() && time > self.time {
            self.time = time;
            self.place(*grid.geometry());
            let clusters = self.clusters(grid);
            self.follow(clusters);
        }
        self.movers(grid).map(|(mover, _)| mover).collect()
    }

    /// The grid without what moves: a plan among movers must not take their places now for walls.
    pub fn without_movers(&self, grid: &OccupancyGrid) -> OccupancyGrid {
        let mut still = grid.clone();
        for (_, track) in self.movers(grid) {
            for centre in &track.cells {
                if let Some(cell) = grid.geometry().cell_at(*centre) {
                    still.set(cell, Cell::Free);
                }
            }
        }
        still
    }

    /// Tracks that are believed to move, at their places now.
    fn movers<'a>(&'a self, grid: &'a OccupancyGrid) -> impl Iterator<Item = (Mover, &'a Track)> {
        self.tracks.iter().filter(|track| self.is_mover(track, grid)).filter_map(|track| {
            let mover = Mover::new(track.expected(self.time), track.velocity, track.radius);
            mover.ok().map(|mover| (mover, track))
        })
    }

    fn is_mover(&self, track: &Track, grid: &OccupancyGrid) -> bool {
        let left = track.first.iter().filter(|centre| grid.at(**centre) == Cell::Free).count();
        track.sightings >= self.config.sightings
            && track.velocity.norm() >= self.config.least_speed
            && 2 * left >= track.first.len()
    }

    /// Takes what was seen over to another geometry.
    fn place(&mut self, geometry: GridGeometry) {
        let Some(last) = self.geometry.replace(geometry) else {
            self.free_at = vec![f64::NEG_INFINITY; geometry.len()];
            return;
        };
        if last == geometry {
            return;
        }
        let old = std::mem::take(&mut self.free_at);
        let seen = |linear: usize| {
            let cell = last.cell_at(geometry.center(geometry.cell(linear)));
            cell.map_or(f64::NEG_INFINITY, |cell| old[last.linear(cell)])
        };
        self.free_at = (0..geometry.len()).map(seen).collect();
    }

    /// Notes what is free, and gathers what is newly occupied.
    fn clusters(&mut self, grid: &OccupancyGrid) -> Vec<Cluster> {
        let mut new = Vec::new();
        for (linear, (cell, free_at)) in grid.cells().iter().zip(&mut self.free_at).enumerate() {
            match cell {
                Cell::Free => *free_at = self.time,
                Cell::Occupied if self.time - *free_at <= self.config.memory => new.push(linear),
                _ => {}
            }
        }
        let geometry = grid.geometry();
        let groups =
            connected(geometry, &new).into_iter().filter(|group| group.len() >= self.config.least_cells);
        groups
            .map(|group| cluster(geometry, &group))
            .filter(|cluster| cluster.radius <= self.config.largest)
            .collect()
    }

    /// Ties clusters to tracks, nearest first; the rest begin tracks of their own. Tracks not seen for a window end.
    fn follow(&mut self, clusters: Vec<Cluster>) {
        let (time, config) = (self.time, self.config);
        let mut pairs = Vec::new();
        for (t, track) in self.tracks.iter().enumerate() {
            for (c, cluster) in clusters.iter().enumerate() {
                let off = (track.expected(time) - cluster.middle).norm();
                if off <= config.gate {
                    pairs.push((off, t, c));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut clusters: Vec<Option<Cluster>> = clusters.into_iter().map(Some).collect();
        let mut found = vec![false; self.tracks.len()];
        for (_, t, c) in pairs {
            if !found[t]
                && let Some(cluster) = clusters[c].take()
            {
                found[t] = true;
                self.tracks[t].add(time, cluster, config.window);
            }
        }
        self.tracks.retain(|track| time - track.seen[track.seen.len() - 1].0 <= config.window);
        self.tracks.extend(clusters.into_iter().flatten().map(|cluster| Track {
            first: cluster.centres.clone(),
            seen: vec![(time, cluster.middle)],
            sightings: 1,
            radius: cluster.radius,
            velocity: Vector2::zeros(),
            cells: cluster.centres,
        }));
    }
}

/// Groups of cells that touch, at a side or a corner; `cells` rise.
fn connected(geometry: &GridGeometry, cells: &[usize]) -> Vec<Vec<CellIndex>> {
    let mut open = vec![true; cells.len()];
    let mut groups = Vec::new();
    for first in 0..cells.len() {
        if !std::mem::replace(&mut open[first], false) {
            continue;
        }
        let (mut group, mut next) = (vec![geometry.cell(cells[first])], 0);
        while let Some(CellIndex { col, row }) = group.get(next).copied() {
            next += 1;
            for row in row.saturating_sub(1)..(row + 2).min(geometry.height) {
                for col in col.saturating_sub(1)..(col + 2).min(geometry.width) {
                    let cell = CellIndex { col, row };
                    if let Ok(place) = cells.binary_search(&geometry.linear(cell))
                        && std::mem::replace(&mut open[place], false)
                    {
                        group.push(cell);
                    }
                }
            }
        }
        groups.push(group);
    }
    groups
}

/// The middle of the cells' box, and a radius about it that holds all of each cell.
fn cluster(geometry: &GridGeometry, cells: &[CellIndex]) -> Cluster {
    let centres: Vec<Vector2> = cells.iter().map(|cell| geometry.center(*cell)).collect();
    let low = centres.iter().fold(centres[0], |low, c| low.inf(c));
    let high = centres.iter().fold(centres[0], |high, c| high.sup(c));
    let middle = (low + high) / 2.0;
    let reach = centres.iter().map(|c| (c - middle).norm()).fold(0.0, f64::max);
    Cluster { centres, middle, radius: reach + geometry.resolution * std::f64::consts::FRAC_1_SQRT_2 }
}

/// The slope of the straight line through places over time, by least squares.
fn velocity(seen: &[(f64, Vector2)]) -> Vector2 {
    let count = seen.len() as f64;
    let mean_time = seen.iter().map(|(time, _)| time).sum::<f64>() / count;
    let spread: f64 = seen.iter().map(|(time, _)| (time - mean_time).powi(2)).sum();
    if spread <= 0.0 {
        return Vector2::zeros();
    }
    seen.iter().map(|(time, at)| at * (time - mean_time)).sum::<Vector2>() / spread
}

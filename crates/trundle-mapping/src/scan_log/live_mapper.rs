//! Map that follows corrections of the trajectory by redrawing logged scans.

use crate::grid_mapper::{GridMapper, Insertion};
use crate::scan_log::entry::{EntryData, EntryKind, LogEntry, halve_the_older_half, thin};
use crate::scan_match::MatchedMap;
use std::sync::Arc;
use trundle_core::{CellIndex, Invalid, OccupancyGrid, Pose2, Scan, Stamp, Vector2};
use trundle_grid::{LogOddsGrid, MapperConfig};

/// A live map that follows corrections of the trajectory.
///
/// Problem: a loop closure moves poses of scans drawn minutes ago. The log stores the scans. [`LiveMapper::correct`] sets their corrected
/// poses, and [`LiveMapper::work`] redraws them into a second map, in slices with a budget in cells. Drawing begins at the last snapshot
/// before the first scan that moved, not at the first scan. Snapshots share their tiles: a snapshot costs only the changes since the
/// previous one. At the end the new map replaces the old one. Cost of a call: its budget, and two passes over the grid for a whole
/// redrawing.
#[derive(Debug, Clone)]
pub struct LiveMapper {
    front: GridMapper,
    /// Evidence from before the first scan.
    known: LogOddsGrid,
    /// Whether scans are matched to `known` where it is known.
    is_given: bool,
    kept: Vec<LogEntry>,
    snapshots: Vec<Snapshot>,
    /// Number of log entries between snapshots.
    every: usize,
    /// Number of stored entries at which the log is thinned.
    thin_at: usize,
    redrawing: Option<Redrawing>,
}

/// The evidence after a number of drawn entries.
#[derive(Debug, Clone)]
struct Snapshot {
    drawn: usize,
    evidence: LogOddsGrid,
}

#[derive(Debug, Clone)]
struct Redrawing {
    back: GridMapper,
    drawn: usize,
}

/// Result of a slice of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Redrawn {
    /// Cells drawn.
    pub cells: usize,
    /// Number of scans left to draw; at 0 the map is that of the corrected poses.
    pub left: usize,
}

/// Number of log entries at which the log is first thinned, and again after each doubling. Source: ours.
const MIN_THINNING_SIZE: usize = 1024;
/// Maximum number of log entries. Beyond it, every second entry of the older half is dropped. Source: ours.
const MAX_LOG_ENTRIES: usize = 30_000;
/// Number of log entries between two snapshots. Source: ours.
const SNAPSHOT_INTERVAL: usize = 64;
/// Maximum number of snapshots. At this number, the interval doubles. Source: ours.
const MAX_SNAPSHOTS: usize = 16;

impl LiveMapper {
    /// An empty map.
    ///
    /// # Errors
    /// When the configuration is out of range.
    pub fn new(config: MapperConfig) -> Result<Self, Invalid> {
        Ok(Self::over(GridMapper::new(config)?))
    }

    /// A map that continues from one of the robot's own drawing. Corrections do not move the saved part.
    ///
    /// # Errors
    /// As [`GridMapper::from_grid`].
    pub fn from_grid(config: MapperConfig, grid: &OccupancyGrid) -> Result<Self, Invalid> {
        Ok(Self::over(GridMapper::from_grid(config, grid)?))
    }

    /// A map that begins with a given one, to which scans are matched where it is known. Corrections do not move the given part.
    ///
    /// # Errors
    /// As [`GridMapper::from_grid`].
    pub fn on_given(config: MapperConfig, grid: &OccupancyGrid) -> Result<Self, Invalid> {
        Ok(Self { is_given: true, ..Self::from_grid(config, grid)? })
    }

    fn over(front: GridMapper) -> Self {
        let known = front.evidence().clone();
        Self {
            front,
            known,
            is_given: false,
            kept: Vec::new(),
            snapshots: Vec::new(),
            every: SNAPSHOT_INTERVAL,
            thin_at: MIN_THINNING_SIZE,
            redrawing: None,
        }
    }

    /// Draws `scan`, taken with the base at `map_from_base`; logs the scan if its pose differs enough from the last logged one.
    pub fn insert(&mut self, map_from_base: Pose2, scan: &Scan) -> Insertion {
        let insertion = self.front.insert(map_from_base, scan);
        self.keep(scan.stamp(), map_from_base, EntryKind::Scan, || EntryData::Scan(Arc::new(scan.into())));
        insertion
    }

    /// As [`GridMapper::mark_free_disc`]; corrections move the disc with the previous scan.
    pub fn mark_free_disc(&mut self, map_from_base: Pose2, radius: f64) {
        self.front.mark_free_disc(map_from_base, radius);
        self.keep(self.last_stamp(), map_from_base, EntryKind::FreeDisc, || EntryData::FreeDisc { radius });
    }

    /// As [`GridMapper::mark_occupied`]; corrections move the points with the previous scan.
    pub fn mark_occupied(&mut self, map_from_base: Pose2, points: &[Vector2]) {
        self.front.mark_occupied(map_from_base, points);
        self.keep(self.last_stamp(), map_from_base, EntryKind::Contact, || EntryData::Contact {
            points: points.into(),
        });
    }

    /// Sets corrected poses: `pose` maps the stamp of a scan and the pose of its drawing to the corrected pose. Returns the number of moved
    /// scans; [`LiveMapper::work`] redraws them.
    pub fn correct(&mut self, pose: impl Fn(Stamp, Pose2) -> Pose2) -> usize {
        let (mut moved, mut first) = (0, None);
        for (i, kept) in self.kept.iter_mut().enumerate() {
            let now = pose(kept.stamp, kept.map_from_base);
            let off = kept.map_from_base.inverse() * now;
            if now.is_finite() && (off.position().norm() > MIN_CORRECTION || off.theta.abs() > MIN_CORRECTION)
            {
                kept.shift(now);
                moved += 1;
                first = first.or(Some(i));
            }
        }
        if let Some(first) = first {
            self.redraw_from(first);
        }
        moved
    }

    /// Redraws for about `budget` cells.
    pub fn work(&mut self, budget: usize) -> Redrawn {
        self.work_within(budget, usize::MAX)
    }

    /// Redraws about `budget` cells, or the share of the rest that finishes within `calls` calls if that is more.
    pub fn work_within(&mut self, budget: usize, calls: usize) -> Redrawn {
        let mut cells = 0;
        let Some(mut redrawing) = self.redrawing.take() else { return Redrawn { cells, left: 0 } };
        let due = redrawing.drawn + (self.kept.len() - redrawing.drawn).div_ceil(calls.max(1));
        while redrawing.drawn < self.kept.len() && (cells < budget || redrawing.drawn < due) {
            cells += self.kept[redrawing.drawn].integrate_into(&mut redrawing.back);
            redrawing.drawn += 1;
            self.note(redrawing.drawn, redrawing.back.evidence());
        }
        let left = self.kept.len() - redrawing.drawn;
        if left == 0 {
            self.front.replace_with(redrawing.back);
        } else {
            self.redrawing = Some(redrawing);
        }
        Redrawn { cells, left }
    }

    /// Whether work is left.
    pub fn is_redrawing(&self) -> bool {
        self.redrawing.is_some()
    }

    /// The map in use.
    pub fn mapper(&self) -> &GridMapper {
        &self.front
    }

    /// The map that scans are matched to.
    pub fn matched_map(&self) -> MatchedMap<'_> {
        if self.is_given { MatchedMap::over(&self.front, &self.known) } else { (&self.front).into() }
    }

    /// Whether a point of the map frame (m) is in the known part of a given map.
    pub fn is_given_at(&self, point: Vector2) -> bool {
        self.matched_map().is_given(point)
    }

    /// Three-valued grid of the map.
    pub fn grid(&self) -> &OccupancyGrid {
        self.front.grid()
    }

    /// As [`GridMapper::revision`].
    pub fn revision(&self) -> u64 {
        self.front.revision()
    }

    /// As [`GridMapper::changes_since`].
    pub fn changes_since(&self, revision: u64) -> impl Iterator<Item = (CellIndex, (usize, usize))> {
        self.front.changes_since(revision)
    }

    /// Log-odds at a point of the map frame (m).
    pub fn log_odds_at(&self, point: Vector2) -> f64 {
        self.front.log_odds_at(point)
    }

    /// Stamps of the scans in the log; corrections move only these.
    pub fn logged_stamps(&self) -> impl Iterator<Item = Stamp> {
        self.kept.iter().map(|kept| kept.stamp)
    }

    /// Number of scans and free discs in the log.
    pub fn logged_entries(&self) -> usize {
        self.kept.len()
    }

    /// Adds the entry just drawn to the log. An entry near the last of its kind replaces that one, unless a snapshot contains it.
    fn keep(
        &mut self,
        stamp: Stamp,
        map_from_base: Pose2,
        kind: EntryKind,
        data: impl FnOnce() -> EntryData,
    ) {
        if !map_from_base.is_finite() {
            return;
        }
        let new = |anchor| LogEntry { stamp, map_from_base, anchor, data: data() };
        if let Some(last) = LogEntry::repeated(&self.kept, map_from_base, kind) {
            if !self.is_drawn_elsewhere(last) {
                self.kept[last] = new(self.kept[last].anchor);
            }
            return;
        }
        self.kept.push(new(map_from_base));
        if self.redrawing.is_none() {
            self.note(self.kept.len(), &self.front.evidence().clone());
        }
        // Thinning would restart a redraw.
        if self.kept.len() >= self.thin_at && self.redrawing.is_none() {
            self.thin();
        }
    }

    /// Whether a snapshot, or the map being redrawn, contains one of the logged entries.
    fn is_drawn_elsewhere(&self, kept: usize) -> bool {
        self.snapshots.last().is_some_and(|snapshot| snapshot.drawn > kept)
            || self.redrawing.as_ref().is_some_and(|redrawing| redrawing.drawn > kept)
    }

    fn last_stamp(&self) -> Stamp {
        self.kept.last().map_or(Stamp::default(), |kept| kept.stamp)
    }

    /// Takes a snapshot if one is due.
    fn note(&mut self, drawn: usize, evidence: &LogOddsGrid) {
        if drawn.is_multiple_of(self.every) {
            self.snapshots.push(Snapshot { drawn, evidence: evidence.clone() });
            if self.snapshots.len() > MAX_SNAPSHOTS {
                self.every *= 2;
                let every = self.every;
                self.snapshots.retain(|snapshot| snapshot.drawn.is_multiple_of(every));
            }
        }
    }

    fn redraw_from(&mut self, first: usize) {
        // A redraw that has not reached the first moved entry continues.
        if let Some(redrawing) = self.redrawing.as_mut().filter(|redrawing| redrawing.drawn <= first) {
            debug_assert!(redrawing.drawn <= self.kept.len(), "the drawn cells are kept");
            return;
        }
        self.snapshots.retain(|snapshot| snapshot.drawn <= first);
        let (evidence, drawn) = match self.snapshots.last() {
            Some(snapshot) => (snapshot.evidence.clone(), snapshot.drawn),
            None => (self.known.clone(), 0),
        };
        self.redrawing = Some(Redrawing { back: self.front.with_evidence(evidence), drawn });
    }

    /// Drops entries repeated by newer ones of the same place, with the snapshots that contain them.
    fn thin(&mut self) {
        thin(&mut self.kept);
        while self.kept.len() > MAX_LOG_ENTRIES / 2 && halve_the_older_half(&mut self.kept) {}
        self.thin_at = (2 * self.kept.len()).clamp(MIN_THINNING_SIZE, MAX_LOG_ENTRIES);
        self.snapshots.clear();
        self.every = SNAPSHOT_INTERVAL;
    }
}

/// Smallest correction of a pose that is applied \[m, rad\]. Source: ours.
const MIN_CORRECTION: f64 = 1e-4;

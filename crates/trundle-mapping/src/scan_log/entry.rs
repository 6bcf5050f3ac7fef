//! Entries of the scan log, and thinning of the log.

use crate::grid_mapper::{GridMapper, Insertion};
use crate::scan_log::packed_scan::PackedScan;
use std::{collections::HashMap, sync::Arc};
use trundle_core::{Pose2, Stamp, Vector2};

/// A drawn entry that can be redrawn.
#[derive(Debug, Clone)]
pub(crate) struct LogEntry {
    pub(crate) stamp: Stamp,
    pub(crate) map_from_base: Pose2,
    /// Pose at which the first replaced scan was taken.
    pub(crate) anchor: Pose2,
    pub(crate) data: EntryData,
}

#[derive(Debug, Clone)]
pub(crate) enum EntryData {
    Scan(Arc<PackedScan>),
    FreeDisc { radius: f64 },
    Contact { points: Arc<[Vector2]> },
}

/// Kind of an entry, without its data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EntryKind {
    Scan,
    FreeDisc,
    Contact,
}

impl EntryData {
    fn kind(&self) -> EntryKind {
        match self {
            Self::Scan(_) => EntryKind::Scan,
            Self::FreeDisc { .. } => EntryKind::FreeDisc,
            Self::Contact { .. } => EntryKind::Contact,
        }
    }
}

/// Minimum distance from the last entry of its kind at which an entry is logged \[m\]. A nearer scan is added to the map only. Source:
/// ours.
const MIN_ENTRY_DISTANCE_M: f64 = 0.1;
/// Minimum turn from the last entry of its kind at which an entry is logged \[rad\]. Source: ours.
const MIN_ENTRY_TURN_RAD: f64 = 0.1;
/// Side of the squares by which scans are thinned \[m\]. Source: ours.
const SCAN_SQUARE_M: f64 = 0.5;
/// Side of the squares by which discs and contacts are thinned \[m\]. Source: ours.
const SMALL_SQUARE_M: f64 = 0.1;
/// Width of the sectors of heading by which entries are thinned \[rad\]. Source: ours.
const HEADING_SECTOR_RAD: f64 = std::f64::consts::FRAC_PI_6;
/// Maximum number of scans of one square and sector, that of one pass. Older scans are dropped. Source: ours.
const MAX_SCANS_PER_SQUARE: u32 = 5;
/// Minimum cost of redrawing an entry \[cells\]. Source: ours.
const MIN_ENTRY_COST_CELLS: usize = 200;

impl LogEntry {
    /// The stored entry that makes a new one of `kind` at `map_from_base` redundant: the last of its kind, if near enough. A touch is
    /// always stored.
    pub(crate) fn repeated(kept: &[Self], map_from_base: Pose2, kind: EntryKind) -> Option<usize> {
        let last = kept.iter().rposition(|kept| kept.data.kind() == kind)?;
        (kind != EntryKind::Contact && is_near(kept[last].anchor, map_from_base)).then_some(last)
    }

    /// Moves the entry to its corrected pose.
    pub(crate) fn shift(&mut self, now: Pose2) {
        self.anchor = now * (self.map_from_base.inverse() * self.anchor);
        self.map_from_base = now;
    }

    /// Draws the entry; returns the cost in cells.
    pub(crate) fn integrate_into(&self, mapper: &mut GridMapper) -> usize {
        match &self.data {
            EntryData::Scan(scan) => {
                let Insertion { hits, free, .. } = mapper.insert(self.map_from_base, &scan.unpack());
                return hits + free + MIN_ENTRY_COST_CELLS;
            }
            EntryData::FreeDisc { radius } => mapper.mark_free_disc(self.map_from_base, *radius),
            EntryData::Contact { points } => mapper.mark_occupied(self.map_from_base, points),
        }
        MIN_ENTRY_COST_CELLS
    }

    /// Kind, place and direction of the entry, and the maximum number of such entries.
    fn place(&self) -> (PoseBin, u32) {
        let (kind, side, enough) = match self.data {
            EntryData::Scan(_) => (0, SCAN_SQUARE_M, MAX_SCANS_PER_SQUARE),
            EntryData::FreeDisc { .. } => (1, SMALL_SQUARE_M, 1),
            EntryData::Contact { .. } => (2, SMALL_SQUARE_M, 1),
        };
        let pose = self.map_from_base;
        let cell = |value: f64, side: f64| (value / side).floor() as i64;
        ((kind, cell(pose.x, side), cell(pose.y, side), cell(pose.theta, HEADING_SECTOR_RAD)), enough)
    }
}

/// Kind, column, row and direction.
type PoseBin = (u8, i64, i64, i64);

/// Drops entries with enough newer ones of the same place and direction. The log therefore grows with the area, not with time.
pub(crate) fn thin(kept: &mut Vec<LogEntry>) {
    let mut newer: HashMap<PoseBin, u32> = HashMap::new();
    let mut stays: Vec<bool> = kept
        .iter()
        .rev()
        .map(|one| {
            let (place, enough) = one.place();
            let there = newer.entry(place).or_default();
            *there += 1;
            *there <= enough
        })
        .collect();
    kept.retain(|_| stays.pop().expect("invariant: one word for each thing kept"));
}

/// Drops every second scan and disc of the older half. Returns whether any was dropped.
pub(crate) fn halve_the_older_half(kept: &mut Vec<LogEntry>) -> bool {
    let (before, half) = (kept.len(), kept.len() / 2);
    let (mut i, mut scans, mut discs) = (0, 0, 0);
    kept.retain(|one| {
        i += 1;
        let nth = match one.data {
            EntryData::Scan(_) => &mut scans,
            EntryData::FreeDisc { .. } => &mut discs,
            EntryData::Contact { .. } => return true,
        };
        *nth += 1;
        i > half || *nth % 2 == 1
    });
    kept.len() < before
}

fn is_near(a: Pose2, b: Pose2) -> bool {
    let step = a.inverse() * b;
    step.position().norm() < MIN_ENTRY_DISTANCE_M && step.theta.abs() < MIN_ENTRY_TURN_RAD
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_second_entry_of_the_older_half_is_dropped_and_no_touch() {
        let kinds = |i: usize| match i % 3 {
            0 => EntryData::FreeDisc { radius: i as f64 },
            1 => EntryData::FreeDisc { radius: -(i as f64) },
            _ => EntryData::Contact { points: Arc::new([]) },
        };
        let one = |i| LogEntry {
            stamp: Stamp::default(),
            map_from_base: Pose2::IDENTITY,
            anchor: Pose2::IDENTITY,
            data: kinds(i),
        };
        let mut kept: Vec<_> = (0..12).map(one).collect();
        halve_the_older_half(&mut kept);
        let discs = |range: std::ops::Range<usize>| {
            kept[range].iter().filter(|one| matches!(one.data, EntryData::FreeDisc { .. })).count()
        };
        assert_eq!((kept.len(), discs(0..4), discs(4..10)), (10, 2, 4));
    }
}

//! The result of a mapped log.

use super::counts::ScanCounts;
use trundle_core::{Cell, OccupancyGrid};
use trundle_io::{LaserLog, empty_map_cause};

/// The result of a log.
#[derive(Debug)]
pub struct LaserMapRun {
    /// What became of the scans.
    pub counts: ScanCounts,
    /// Memory of maps, scans and trajectories, MB.
    pub megabytes: f64,
    /// Wall-clock time, s.
    pub seconds: f64,
    /// Whether the user ended it before the last scan.
    pub is_interrupted: bool,
    /// What is probably wrong with the laser's mount, where the scans contradict the odometry at many steps.
    pub mount_hint: Option<String>,
    /// Why the run missed its aim; `None` where it did not.
    pub failure: Option<String>,
}

impl LaserMapRun {
    /// Why a log that gave these counts and this map, where one was made, missed the aim, with the likely cause.
    pub(super) fn failure_of(
        log: &LaserLog,
        counts: &ScanCounts,
        grid: Option<&OccupancyGrid>,
    ) -> Option<String> {
        let is_in = |cell: Cell| grid.is_none_or(|grid| grid.cells().contains(&cell));
        let failure = if counts.processed == 0 {
            "no scan was put into the map or found in it"
        } else if !is_in(Cell::Free) && !is_in(Cell::Occupied) {
            "the map has no known cell"
        } else if !is_in(Cell::Occupied) {
            "the map has no occupied cell"
        } else {
            return None;
        };
        Some(format!("{failure}: {}", empty_map_cause(log)))
    }

    /// Wall-clock time of a processed scan, ms.
    #[must_use]
    pub fn scan_ms(&self) -> f64 {
        self.seconds * 1e3 / (self.counts.processed + self.counts.lost).max(1) as f64
    }
}

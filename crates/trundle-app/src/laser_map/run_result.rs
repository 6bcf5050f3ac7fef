//! The result of a mapped log.

use super::counts::ScanCounts;

/// The result of a log.
#[derive(Debug)]
pub struct LaserMapRun {
    /// What became of the scans.
    pub counts: ScanCounts,
    /// Memory of maps, scans and trajectories, MB.
    pub megabytes: f64,
    /// Wall-clock time, s.
    pub seconds: f64,
}

impl LaserMapRun {
    /// Wall-clock time of a processed scan, ms.
    #[must_use]
    pub fn scan_ms(&self) -> f64 {
        self.seconds * 1e3 / (self.counts.processed + self.counts.lost).max(1) as f64
    }
}

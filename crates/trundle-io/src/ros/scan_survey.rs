//! What the scans of a topic show together, without their ranges.

use super::messages::LaserScan;
use std::collections::BTreeSet;
use trundle_core::Stamp;

/// The scans of one topic of a bag, surveyed as they come.
#[derive(Debug, Default)]
pub(in crate::ros) struct ScanSurvey {
    /// Number of scans.
    pub(in crate::ros) count: usize,
    /// Stamps of the first and the last scan of the bag.
    pub(in crate::ros) times: Option<(Stamp, Stamp)>,
    /// Frames of the laser.
    pub(in crate::ros) frames: BTreeSet<String>,
}

impl ScanSurvey {
    /// Surveys the next scan.
    pub(in crate::ros) fn take(&mut self, scan: LaserScan) {
        self.count += 1;
        self.times = Some((self.times.map_or(scan.stamp, |(first, _)| first), scan.stamp));
        if !self.frames.contains(&scan.frame) {
            self.frames.insert(scan.frame);
        }
    }
}

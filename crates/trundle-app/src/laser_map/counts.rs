//! Counts of a log's scans by their result.

use trundle_core::Stamp;
use trundle_mapping::{Localized, MappingPause, Processed, ScanUpdate};

/// Numbers of scans of a log, by the filter's result.
#[derive(Debug, Default)]
pub struct ScanCounts {
    /// Scans of the log, those that were not read included.
    pub in_log: usize,
    /// Scans that the filter received: all of a log that was read to its end.
    pub read: usize,
    /// Scans inserted into the map or localized in it.
    pub processed: usize,
    /// Scans refused.
    pub refused: usize,
    /// Jumps of the odometry.
    pub jumps: usize,
    /// Steps with wrong odometry.
    pub slips: usize,
    /// Resamplings.
    pub resamplings: usize,
    /// Scans without overlap with the map.
    pub without_overlap: usize,
    /// Scans with a degenerate direction: the pose along it is that of the odometry.
    pub degenerate: usize,
    /// Loop closures that corrected the trajectory.
    pub corrections: usize,
    /// Scans while the pose was not known.
    pub lost: usize,
    /// Pauses of mapping, because scans contradicted the loaded map.
    pub pauses: usize,
    /// Scans left out by these pauses: those removed from the map, and those until the robot was localized.
    pub left_out: usize,
    /// Stamp of the first scan that was left out.
    pub first_pause: Option<Stamp>,
    /// Whether mapping is paused.
    pub(super) is_paused: bool,
}

impl ScanCounts {
    /// Counts a scan in a map that grows.
    pub fn count(&mut self, update: &ScanUpdate) {
        self.read += 1;
        match update {
            ScanUpdate::Processed(done) => self.count_processed(done),
            ScanUpdate::Refused(_) => self.refused += 1,
            ScanUpdate::Lost(_) => {
                self.lost += 1;
                self.left_out += usize::from(self.is_paused);
            }
            ScanUpdate::Paused(pause) => self.count_pause(*pause),
            ScanUpdate::Found(_) => {
                self.processed += 1;
                self.is_paused = false;
            }
            ScanUpdate::Still => {}
        }
    }

    /// Counts a scan in a map that does not change.
    pub fn count_localized(&mut self, localized: &Localized) {
        self.read += 1;
        match localized {
            Localized::Known { degenerate, .. } => {
                self.processed += 1;
                self.without_overlap += usize::from(*degenerate == 3);
                self.degenerate += usize::from(*degenerate > 0);
            }
            Localized::Refused(_) => self.refused += 1,
            Localized::Lost(_) => self.lost += 1,
            Localized::Still => {}
        }
    }

    /// The scan at which the pause begins is left out too.
    fn count_pause(&mut self, pause: MappingPause) {
        self.pauses += 1;
        self.processed = self.processed.saturating_sub(pause.removed_scans);
        self.left_out += pause.removed_scans + 1;
        self.lost += pause.removed_scans + 1;
        self.first_pause.get_or_insert(pause.since);
        self.is_paused = true;
    }

    fn count_processed(&mut self, done: &Processed) {
        self.processed += 1;
        self.jumps += usize::from(done.jumped);
        self.slips += usize::from(done.slipped);
        self.resamplings += usize::from(done.resampled);
        self.without_overlap += usize::from(done.degenerate == 3);
        self.degenerate += usize::from(done.degenerate > 0);
        self.corrections += usize::from(done.loop_correction_m.is_some());
    }
}

//! Counts of a log's scans by their result.

use trundle_mapping::{Localized, Processed, ScanUpdate};

/// The scans of a log, by what the filter made of them.
#[derive(Debug, Default)]
pub struct ScanCounts {
    /// Scans put into the map or found in it.
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
    /// Scans with a direction left to the odometry.
    pub degenerate: usize,
    /// Loop closures that corrected the trajectory.
    pub corrections: usize,
    /// Scans while the pose was not known.
    pub lost: usize,
}

impl ScanCounts {
    /// Counts a scan in a map that grows.
    pub fn count(&mut self, update: &ScanUpdate) {
        match update {
            ScanUpdate::Processed(done) => self.count_processed(done),
            ScanUpdate::Refused(_) => self.refused += 1,
            ScanUpdate::Lost(_) => self.lost += 1,
            ScanUpdate::Found(_) => self.processed += 1,
            ScanUpdate::Still => {}
        }
    }

    /// Counts a scan in a map that does not change.
    pub fn count_localized(&mut self, localized: &Localized) {
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

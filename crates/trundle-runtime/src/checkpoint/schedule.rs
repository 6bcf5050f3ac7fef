//! When checkpoints are made.

use trundle_core::Stamp;

/// When the visual maps are saved: the less there is to be saved, the more often. By the data's time.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct CheckpointSchedule {
    due: Option<Stamp>,
}

/// So much is saved a second, bytes: small maps are no load, large ones (an hour: some 20 MB) are saved seldom.
const RATE: f64 = 3e5;
/// At least and at most so long from one save to the next, s. The longest is what a robot that is killed may have forgotten.
const PERIOD: (f64, f64) = (3.0, 10.0);

impl CheckpointSchedule {
    /// Whether it is time to save.
    pub(crate) fn is_due(&self, now: Stamp) -> bool {
        self.due.is_none_or(|due| now >= due)
    }

    /// So many bytes were saved.
    pub(crate) fn saved(&mut self, now: Stamp, bytes: usize) {
        self.due = Some(now.after((bytes as f64 / RATE).clamp(PERIOD.0, PERIOD.1)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_maps_are_saved_seldom() {
        let at = |seconds: f64| Stamp::default().after(seconds);
        let mut saving = CheckpointSchedule::default();
        assert!(saving.is_due(at(0.0)));
        for (bytes, period) in [(1000, 3.0), (1_500_000, 5.0), (30_000_000, 10.0)] {
            saving.saved(at(0.0), bytes);
            assert!(!saving.is_due(at(period - 0.1)) && saving.is_due(at(period)), "{bytes} bytes");
        }
    }
}

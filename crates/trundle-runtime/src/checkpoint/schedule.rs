//! Times at which checkpoints are made.

use trundle_core::Stamp;

/// Schedule of the checkpoints, by the data's time. Small maps are saved more often.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct CheckpointSchedule {
    due: Option<Stamp>,
}

/// Mean rate of writing \[bytes/s\]: a large map (20 MB after an hour) is saved seldom. Source: ours.
const WRITE_RATE_BYTES_PER_S: f64 = 3e5;
/// Shortest time between two checkpoints \[s\]. Source: ours.
const MIN_PERIOD_S: f64 = 3.0;
/// Longest time between two checkpoints \[s\]: the loss if the robot's process is killed. Source: ours.
const MAX_PERIOD_S: f64 = 10.0;

impl CheckpointSchedule {
    /// Whether a checkpoint is due.
    pub(crate) fn is_due(&self, now: Stamp) -> bool {
        self.due.is_none_or(|due| now >= due)
    }

    /// Records the size of a checkpoint.
    pub(crate) fn saved(&mut self, now: Stamp, bytes: usize) {
        self.due = Some(now.after((bytes as f64 / WRITE_RATE_BYTES_PER_S).clamp(MIN_PERIOD_S, MAX_PERIOD_S)));
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

    #[test]
    fn the_longest_period_bounds_what_a_restart_loses() {
        let mut saving = CheckpointSchedule::default();
        saving.saved(Stamp::default(), usize::MAX);
        assert!(saving.is_due(Stamp::default().after(10.0)));
        saving.saved(Stamp::default(), 0);
        assert!(!saving.is_due(Stamp::default().after(2.9)) && saving.is_due(Stamp::default().after(3.0)));
    }
}

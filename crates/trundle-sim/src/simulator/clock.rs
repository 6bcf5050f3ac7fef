//! The clock of a sensor with a fixed rate.

use crate::kobuki::STEPS_PER_SECOND;

/// Due times of a sensor: the n-th reading is at the step nearest to n / rate.
#[derive(Debug)]
pub(super) struct Clock {
    /// `None`: never.
    steps: Option<f64>,
    ticks: u64,
}

impl Clock {
    pub(super) fn new(rate_hz: f64) -> Self {
        Self { steps: Some(STEPS_PER_SECOND / rate_hz), ticks: 0 }
    }

    pub(super) fn never() -> Self {
        Self { steps: None, ticks: 0 }
    }

    /// The number of the reading due at step `now`, from 0. Must be called at every step; returns each number once.
    pub(super) fn due(&mut self, now: u64) -> Option<u64> {
        let tick = self.ticks;
        let is_due = self.steps.is_some_and(|steps| now >= (tick as f64 * steps).round() as u64);
        self.ticks += u64::from(is_due);
        is_due.then_some(tick)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_are_at_the_nearest_steps() {
        let mut clock = Clock::new(30.0);
        let due: Vec<u64> = (0..=1000).filter(|now| clock.due(*now).is_some()).collect();
        assert_eq!((due[..4].to_vec(), due.len()), (vec![0, 33, 67, 100], 31));
        assert_eq!(Clock::never().due(0), None);
    }
}

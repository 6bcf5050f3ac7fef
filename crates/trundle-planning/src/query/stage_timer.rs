//! Times of the stages of a plan.

use std::cell::Cell;

/// Times of the stages of the last plan, s. All 0 without a clock.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PlanningTimes {
    /// Update of the distance field.
    pub field: f64,
    /// Search and string pulling.
    pub waypoints: f64,
    /// Corridors, programs and checks.
    pub curve: f64,
    /// Speed profile and samples over time.
    pub timing: f64,
}

impl PlanningTimes {
    /// The sums of the stages.
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            field: self.field + other.field,
            waypoints: self.waypoints + other.waypoints,
            curve: self.curve + other.curve,
            timing: self.timing + other.timing,
        }
    }
}

/// Adds up the times of stages by the caller's clock; this crate has none.
#[derive(Debug, Default)]
pub(crate) struct StageTimer {
    clock: Option<fn() -> f64>,
    times: Cell<PlanningTimes>,
}

impl StageTimer {
    pub(crate) fn new(clock: Option<fn() -> f64>) -> Self {
        Self { clock, times: Cell::default() }
    }

    pub(crate) fn times(&self) -> PlanningTimes {
        self.times.get()
    }

    /// Runs `work` and adds its time to a stage.
    pub(crate) fn time<T>(&self, stage: fn(&mut PlanningTimes) -> &mut f64, work: impl FnOnce() -> T) -> T {
        let Some(clock) = self.clock else { return work() };
        let begin = clock();
        let result = work();
        let mut times = self.times.get();
        *stage(&mut times) += clock() - begin;
        self.times.set(times);
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_add_up_by_the_clock_given() {
        use std::sync::atomic::{AtomicU32, Ordering};
        static TICKS: AtomicU32 = AtomicU32::new(0);
        let timer = StageTimer::new(Some(|| f64::from(TICKS.fetch_add(1, Ordering::Relaxed))));
        assert_eq!(timer.time(|t| &mut t.curve, || 7), 7);
        timer.time(|t| &mut t.curve, || timer.time(|t| &mut t.timing, || ()));
        assert_eq!(timer.times(), PlanningTimes { curve: 4.0, timing: 1.0, ..PlanningTimes::default() });
        assert_eq!(StageTimer::default().time(|t| &mut t.field, || 3), 3);
    }
}

use std::cell::Cell;

/// How long the stages of the last plan took, s. All 0 without a clock.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StageTimes {
    /// Bringing the distance field up to date.
    pub field: f64,
    /// The search, and pulling its way taut.
    pub way_points: f64,
    /// Corridors, programmes and checks.
    pub curve: f64,
    /// Speeds and samples over time.
    pub timing: f64,
}

impl StageTimes {
    /// Stage by stage.
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            field: self.field + other.field,
            way_points: self.way_points + other.way_points,
            curve: self.curve + other.curve,
            timing: self.timing + other.timing,
        }
    }
}

/// Adds up how long stages take, by a clock of the caller's; this crate has none.
#[derive(Debug, Default)]
pub(crate) struct Stopwatch {
    clock: Option<fn() -> f64>,
    times: Cell<StageTimes>,
}

impl Stopwatch {
    pub(crate) fn new(clock: Option<fn() -> f64>) -> Self {
        Self { clock, times: Cell::default() }
    }

    pub(crate) fn times(&self) -> StageTimes {
        self.times.get()
    }

    /// Does `work` and adds its time to a stage.
    pub(crate) fn time<T>(&self, stage: fn(&mut StageTimes) -> &mut f64, work: impl FnOnce() -> T) -> T {
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
        let watch = Stopwatch::new(Some(|| f64::from(TICKS.fetch_add(1, Ordering::Relaxed))));
        assert_eq!(watch.time(|t| &mut t.curve, || 7), 7);
        watch.time(|t| &mut t.curve, || watch.time(|t| &mut t.timing, || ()));
        assert_eq!(watch.times(), StageTimes { curve: 4.0, timing: 1.0, ..StageTimes::default() });
        assert_eq!(Stopwatch::default().time(|t| &mut t.field, || 3), 3);
    }
}

//! Timing of the control loop: jitter, response, missed deadlines.

use crate::Histogram;
use serde::Serialize;
use std::time::{Duration, Instant};
use trundle_core::{Invalid, require_in};

/// Period and deadlines of the control loop.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LoopTimerConfig {
    /// Time between two readings of the wheels, s, 0.001 to 1. Default 0.02: the Kobuki's 50 Hz.
    pub period: f64,
    /// Time before the next expected reading in which no other work begins, s, 0 to `period`. Default 0.006: an image's result takes 1 to 5
    /// ms.
    pub reserve: f64,
    /// Delay of a command beyond which a deadline is missed, s, above 0 to 10. Default 0.1: at 0.7 m/s the robot moves 7 cm in this time.
    pub deadline: f64,
}

impl Default for LoopTimerConfig {
    fn default() -> Self {
        Self { period: 0.02, reserve: 0.006, deadline: 0.1 }
    }
}

impl LoopTimerConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("period", self.period, "s", 1e-3, 1.0)?;
        require_in("reserve", self.reserve, "s", 0.0, self.period)?;
        require_in("deadline", self.deadline, "s", 1e-3, 10.0)?;
        Ok(self)
    }
}

/// Timing of the control loop: records the times of commands, and decides whether time is left for other work.
#[derive(Debug)]
pub struct LoopTimer {
    config: LoopTimerConfig,
    /// Time at which processing of the last wheel reading began.
    beat: Option<Instant>,
    /// Time of the last command.
    command: Option<Instant>,
    intervals: Histogram,
    jitter: Histogram,
    responses: Histogram,
    missed: u64,
}

/// Timing of control, ms; quantiles have an error of at most 1 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LoopTimerReport {
    /// Number of control steps.
    pub steps: u64,
    /// Time between two commands, median.
    pub interval_median_ms: f64,
    /// Deviation of the time between two commands from the period, median.
    pub jitter_median_ms: f64,
    /// Deviation of the time between two commands from the period, 99th percentile.
    pub jitter_p99_ms: f64,
    /// Deviation of the time between two commands from the period, 99.9th percentile.
    pub jitter_p999_ms: f64,
    /// Deviation of the time between two commands from the period, maximum.
    pub jitter_most_ms: f64,
    /// Time from a wheel reading to its command, median.
    pub response_median_ms: f64,
    /// Time from a wheel reading to its command, 99.9th percentile.
    pub response_p999_ms: f64,
    /// Time from a wheel reading to its command, maximum.
    pub response_most_ms: f64,
    /// Number of intervals between two commands longer than period plus deadline. A base with a time-out stops by itself.
    pub missed_deadlines: u64,
}

impl LoopTimer {
    /// A loop before its first step.
    pub fn new(config: LoopTimerConfig) -> Self {
        Self {
            config,
            beat: None,
            command: None,
            intervals: Histogram::default(),
            jitter: Histogram::default(),
            responses: Histogram::default(),
            missed: 0,
        }
    }

    /// Marks the beginning of the processing of a new wheel reading.
    pub fn begin(&mut self) {
        self.beat = Some(Instant::now());
    }

    /// Marks the command for a reading that arrived at `arrival`.
    pub fn end(&mut self, arrival: Instant) {
        let now = Instant::now();
        self.responses.note((now - arrival).as_secs_f64() * 1e3);
        if let Some(last) = self.command.replace(now) {
            let interval = (now - last).as_secs_f64();
            self.intervals.note(interval * 1e3);
            self.jitter.note((interval - self.config.period).abs() * 1e3);
            self.missed += u64::from(interval > self.config.period + self.config.deadline);
        }
    }

    /// `None` if time is left for other work; else the time until other work may begin, unless a reading arrives first.
    pub fn time_for_others(&self) -> Option<Duration> {
        let LoopTimerConfig { period, reserve, .. } = self.config;
        let since = self.beat?.elapsed().as_secs_f64();
        let is_busy = since > period - reserve && since < period + reserve;
        is_busy.then(|| Duration::from_secs_f64(period + reserve - since))
    }

    /// The timing. `None` before the second command.
    pub fn report(&self) -> Option<LoopTimerReport> {
        Some(LoopTimerReport {
            steps: self.responses.count(),
            interval_median_ms: self.intervals.quantile(0.5)?,
            jitter_median_ms: self.jitter.quantile(0.5)?,
            jitter_p99_ms: self.jitter.quantile(0.99)?,
            jitter_p999_ms: self.jitter.quantile(0.999)?,
            jitter_most_ms: self.jitter.max()?,
            response_median_ms: self.responses.quantile(0.5)?,
            response_p999_ms: self.responses.quantile(0.999)?,
            response_most_ms: self.responses.max()?,
            missed_deadlines: self.missed,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn before_the_first_reading_there_is_time() {
        let mut loop_timer = LoopTimer::new(LoopTimerConfig::default().validated().unwrap());
        assert!(loop_timer.time_for_others().is_none() && loop_timer.report().is_none());
        let always = LoopTimerConfig { reserve: 0.02, ..LoopTimerConfig::default() };
        loop_timer.config = always;
        loop_timer.begin();
        assert!(loop_timer.time_for_others().is_some_and(|wait| wait <= Duration::from_millis(40)));
    }

    #[test]
    fn a_late_command_is_a_missed_deadline() {
        let config = LoopTimerConfig { period: 0.001, reserve: 0.0, deadline: 0.001 };
        let mut loop_timer = LoopTimer::new(config);
        loop_timer.end(Instant::now());
        std::thread::sleep(Duration::from_millis(5));
        loop_timer.end(Instant::now());
        let report = loop_timer.report().unwrap();
        assert_eq!((report.steps, report.missed_deadlines), (2, 1));
        assert!(report.jitter_most_ms > 2.0);
    }

    #[test]
    fn numbers_are_checked() {
        let bad = LoopTimerConfig { reserve: 0.03, ..LoopTimerConfig::default() };
        assert_eq!(bad.validated().unwrap_err().field, "reserve");
    }

    #[test]
    fn shortly_before_the_next_reading_nothing_else_is_begun() {
        let config = LoopTimerConfig { period: 0.05, reserve: 0.02, deadline: 0.1 };
        let mut timer = LoopTimer::new(config);
        timer.begin();
        assert!(timer.time_for_others().is_none(), "30 ms are left");
        std::thread::sleep(Duration::from_millis(35));
        if let Some(wait) = timer.time_for_others() {
            assert!(wait <= Duration::from_millis(35), "until period and reserve are over: {wait:?}");
        }
        std::thread::sleep(Duration::from_millis(40));
        assert!(timer.time_for_others().is_none(), "the reading is overdue: others are not held up");
    }

    #[test]
    fn each_number_is_checked_by_name() {
        let field = |config: LoopTimerConfig| config.validated().unwrap_err().field;
        let good = LoopTimerConfig::default();
        assert_eq!(good.validated(), Ok(good));
        assert_eq!(field(LoopTimerConfig { period: 2.0, ..good }), "period");
        assert_eq!(field(LoopTimerConfig { deadline: 0.0, ..good }), "deadline");
        assert_eq!(field(LoopTimerConfig { reserve: -0.001, ..good }), "reserve");
    }
}

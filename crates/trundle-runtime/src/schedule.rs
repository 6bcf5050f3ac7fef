//! The rates of the stages.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Stamp, require_in};

/// Rates of the stages that do not run at every reading of their sensor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct Schedule {
    /// Rate at which scans enter the map, 1/s, 0.5 to 30. A higher rate takes more time. Default 5: the rate of \[Li18\].
    pub map_hz: f64,
    /// Rate at which the remaining trajectory is checked against the map, 1/s, 0.5 to 30. Default 5: with every new map.
    pub check_hz: f64,
    /// Rate of searches for a faster path during a drive, 1/s, 0 (never) to 30. Without searches, floor that was unknown at the start of
    /// the plan is driven slowly. Default 0 (ours): each search takes as long as a plan.
    pub improve_hz: f64,
}

impl Default for Schedule {
    fn default() -> Self {
        Self { map_hz: 5.0, check_hz: 5.0, improve_hz: 0.0 }
    }
}

impl Schedule {
    /// Returns a valid schedule unchanged.
    ///
    /// # Errors
    /// When a rate is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("schedule.map_hz", self.map_hz, "1/s", 0.5, 30.0)?;
        require_in("schedule.check_hz", self.check_hz, "1/s", 0.5, 30.0)?;
        require_in("schedule.improve_hz", self.improve_hz, "1/s", 0.0, 30.0)?;
        Ok(self)
    }
}

/// Decides by the stamps of the data whether a stage is due.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ticker {
    period: f64,
    last: Option<Stamp>,
}

impl Ticker {
    /// A stage due `hz` times per second; never for 0.
    pub(crate) fn new(hz: f64) -> Self {
        Self { period: 1.0 / hz, last: None }
    }

    /// Makes the stage due at the next query.
    pub(crate) fn make_due(&mut self) {
        self.last = None;
    }

    /// Whether the stage is due at `now`; if due, the next time is counted from `now`. A time up to one millisecond early counts as due.
    pub(crate) fn due(&mut self, now: Stamp) -> bool {
        let due = self.will_be_due(now);
        if due {
            self.last = Some(now);
        }
        due
    }

    /// Result that [`Ticker::due`] would have.
    pub(crate) fn will_be_due(&self, now: Stamp) -> bool {
        self.period.is_finite() && self.last.is_none_or(|last| now - last >= self.period - 1e-3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_a_second_of_thirty() {
        let mut ticker = Ticker::new(5.0);
        let stamps = (0..300).map(|i| Stamp::default().after(f64::from(i) / 30.0));
        assert_eq!(stamps.filter(|&stamp| ticker.due(stamp)).count(), 50);
    }

    #[test]
    fn rates_are_checked() {
        assert!(Schedule { map_hz: f64::NAN, ..Schedule::default() }.validated().is_err());
    }

    #[test]
    fn the_number_of_ticks_is_rate_times_time_whatever_the_input_rate() {
        for (hz, input_hz) in [(1.0, 50.0), (5.0, 15.0), (5.0, 30.0), (10.0, 50.0), (30.0, 30.0)] {
            let mut ticker = Ticker::new(hz);
            let stamps =
                (0..(20.0 * input_hz) as u32).map(|i| Stamp::default().after(f64::from(i) / input_hz));
            let ticks = stamps.filter(|&stamp| ticker.due(stamp)).count();
            assert_eq!(ticks, (20.0 * hz) as usize, "{hz} Hz of {input_hz} Hz");
        }
    }

    #[test]
    fn a_rate_of_zero_is_never_due_and_a_question_changes_nothing() {
        let mut never = Ticker::new(0.0);
        assert!((0..100).all(|i| !never.due(Stamp::default().after(f64::from(i)))));
        let mut ticker = Ticker::new(5.0);
        assert!((0..3).all(|_| ticker.will_be_due(Stamp::default())));
        assert!(ticker.due(Stamp::default()) && !ticker.due(Stamp::default().after(0.1)));
        ticker.make_due();
        assert!(ticker.due(Stamp::default().after(0.11)));
        assert!(!ticker.will_be_due(Stamp::default().after(0.3)), "counted from the last time");
    }

    #[test]
    fn each_rate_is_checked_by_name() {
        let field = |schedule: Schedule| schedule.validated().unwrap_err().field;
        let good = Schedule::default();
        assert_eq!(field(Schedule { map_hz: 0.1, ..good }), "schedule.map_hz");
        assert_eq!(field(Schedule { check_hz: 31.0, ..good }), "schedule.check_hz");
        assert_eq!(field(Schedule { improve_hz: -1.0, ..good }), "schedule.improve_hz");
        assert_eq!(good.validated(), Ok(good));
    }
}

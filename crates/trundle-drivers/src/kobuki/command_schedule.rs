//! Times and speeds of the commands to the base.
//!
//! A base repeats its last command forever. The driver therefore repeats commands, and sends zero without a recent command.

use super::protocol::BaseControl;
use trundle_core::{Stamp, Twist2};

/// Time between repeated commands: 0.02 s. Source: ours, the base's own cycle of 50 Hz.
const REPEAT_PERIOD_S: f64 = 0.02;
/// Smallest time between different commands: 0.005 s. Source: ours; ten bytes each take a fifth of the line. Zero speed does not wait.
const MIN_SPACING_S: f64 = 0.005;

/// The commands of the wheels over time.
#[derive(Debug, Clone)]
pub(super) struct CommandSchedule {
    /// Time after which a command no longer holds, s.
    timeout_s: f64,
    /// The newest command and its time.
    wanted: Option<(BaseControl, Stamp)>,
    /// The last command sent, and when.
    sent: Option<(BaseControl, Stamp)>,
}

impl CommandSchedule {
    pub(super) fn new(timeout_s: f64) -> Self {
        Self { timeout_s, wanted: None, sent: None }
    }

    /// Stores a command with its arrival time `now`.
    pub(super) fn set(&mut self, twist: Twist2, now: Stamp) {
        self.wanted = Some((BaseControl::from_twist(twist), now));
    }

    /// Discards all commands: zero speed is sent next, immediately.
    pub(super) fn restart(&mut self) {
        (self.wanted, self.sent) = (None, None);
    }

    /// The command to send at `now`, if any.
    pub(super) fn due(&mut self, now: Stamp) -> Option<BaseControl> {
        self.wanted = self.wanted.filter(|(_, since)| now - *since < self.timeout_s);
        let wanted = self.wanted.map_or(BaseControl::STOP, |(control, _)| control);
        let (control, is_due) = match self.sent {
            None => (BaseControl::STOP, true),
            Some((last, _)) if wanted == BaseControl::STOP && last != wanted => (wanted, true),
            Some((last, then)) => {
                let wait = if wanted == last { REPEAT_PERIOD_S } else { MIN_SPACING_S };
                (wanted, now - then >= wait)
            }
        };
        is_due.then(|| {
            self.sent = Some((control, now));
            control
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: i64) -> Stamp {
        Stamp::from_nanos(ms * 1_000_000)
    }

    const FORWARD: BaseControl = BaseControl { speed_mm_s: 300, radius_mm: 0 };
    const SLOWER: BaseControl = BaseControl { speed_mm_s: 200, radius_mm: 0 };

    fn forward() -> Twist2 {
        Twist2::new(0.3, 0.0)
    }

    #[test]
    fn zero_comes_first_then_changes_then_repeats() {
        let mut schedule = CommandSchedule::new(0.2);
        schedule.set(forward(), at(0));
        assert_eq!(schedule.due(at(0)), Some(BaseControl::STOP));
        assert_eq!((schedule.due(at(4)), schedule.due(at(5))), (None, Some(FORWARD)));
        assert_eq!((schedule.due(at(24)), schedule.due(at(25))), (None, Some(FORWARD)));
        schedule.set(Twist2::new(0.2, 0.0), at(26));
        assert_eq!((schedule.due(at(26)), schedule.due(at(30))), (None, Some(SLOWER)));
        schedule.set(Twist2::ZERO, at(31));
        assert_eq!(schedule.due(at(31)), Some(BaseControl::STOP));
    }

    #[test]
    fn repeats_are_fifty_a_second() {
        let mut schedule = CommandSchedule::new(10.0);
        schedule.set(forward(), at(0));
        assert_eq!((1..=1000).filter(|ms| schedule.due(at(*ms)).is_some()).count(), 51);
    }

    #[test]
    fn without_commands_the_base_stops() {
        let mut schedule = CommandSchedule::new(0.2);
        schedule.due(at(0));
        schedule.set(forward(), at(10));
        assert_eq!(schedule.due(at(209)), Some(FORWARD));
        assert_eq!(schedule.due(at(210)), Some(BaseControl::STOP));
        assert_eq!(schedule.due(at(230)), Some(BaseControl::STOP));
    }

    #[test]
    fn a_command_from_before_a_restart_is_never_sent() {
        let mut schedule = CommandSchedule::new(0.2);
        schedule.due(at(0));
        schedule.set(forward(), at(10));
        schedule.restart();
        assert!((10..200).filter_map(|ms| schedule.due(at(ms))).all(|control| control == BaseControl::STOP));
    }
}

//! The ROS clock and the run's clock.
//!
//! A run's stamps count from its start. ROS stamps count from 1970, or from the start of a simulator (`use_sim_time`). One constant offset
//! maps between both: a stamp is unchanged after a conversion forth and back.

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};
use std::time::{Instant, SystemTime, UNIX_EPOCH};
use trundle_core::{Invalid, Stamp};

/// Largest age of a message \[s\]: an image over a slow link comes within it. Source: ours.
const MAX_AGE_S: f64 = 1.0;
/// Largest lead of a stamp before the clock \[s\]: clocks of two computers that are synchronised differ by less. Source: ours.
const MAX_LEAD_S: f64 = 0.1;
/// Step back of the simulated clock that is a restart of the simulator \[s\]. Source: ours.
const RESTART_S: f64 = 1.0;
/// Value of a clock that has not begun.
const NOT_BEGUN: i64 = i64::MIN;

/// The ROS clock, and its offset to the run's. Clones share it.
#[derive(Debug, Clone)]
pub struct RosClock {
    source: Source,
}

#[derive(Debug, Clone)]
enum Source {
    /// The computer's clock, read once.
    System { start: Instant, at_start: i64 },
    /// The topic `/clock`.
    Simulated(Arc<Simulated>),
}

/// The newest and the first time of a simulated clock \[ns\].
#[derive(Debug)]
struct Simulated {
    newest: AtomicI64,
    first: AtomicI64,
}

impl RosClock {
    /// The computer's clock; the run begins at this moment.
    #[must_use]
    pub fn system() -> Self {
        Self::system_from(Instant::now())
    }

    /// The computer's clock; the run's stamps count from `start`.
    #[must_use]
    pub fn system_from(start: Instant) -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let at_start = since.saturating_sub(start.elapsed());
        let at_start = i64::try_from(at_start.as_nanos()).unwrap_or_default();
        Self { source: Source::System { start, at_start } }
    }

    /// A simulated clock, which begins with its first message.
    #[must_use]
    pub fn simulated() -> Self {
        let simulated = Simulated { newest: AtomicI64::new(NOT_BEGUN), first: AtomicI64::new(NOT_BEGUN) };
        Self { source: Source::Simulated(Arc::new(simulated)) }
    }

    /// Sets a simulated clock.
    ///
    /// # Errors
    /// When the time decreased: the simulator was restarted.
    pub fn set(&self, time: Stamp) -> Result<(), Invalid> {
        let Source::Simulated(clock) = &self.source else { return Ok(()) };
        let _ = clock.first.compare_exchange(NOT_BEGUN, time.nanos, Ordering::Relaxed, Ordering::Relaxed);
        let newest = clock.newest.fetch_max(time.nanos, Ordering::Relaxed);
        let back = if newest == NOT_BEGUN { 0.0 } else { Stamp::from_nanos(newest) - time };
        if back > RESTART_S {
            let expected =
                "a clock that does not run backward: the simulator was restarted, restart trundle as well";
            return Err(Invalid::new("clock", format!("{back:.1} s back"), "", expected));
        }
        Ok(())
    }

    /// Whether the clock has begun. The computer's always has.
    #[must_use]
    pub fn has_begun(&self) -> bool {
        match &self.source {
            Source::System { .. } => true,
            Source::Simulated(clock) => clock.newest.load(Ordering::Relaxed) != NOT_BEGUN,
        }
    }

    /// The time on the ROS clock.
    #[must_use]
    pub fn ros_now(&self) -> Stamp {
        self.to_ros(self.now())
    }

    /// The time of the run.
    #[must_use]
    pub fn now(&self) -> Stamp {
        match &self.source {
            Source::System { start, .. } => Stamp::default().after(start.elapsed().as_secs_f64()),
            Source::Simulated(clock) if self.has_begun() => {
                Stamp::from_nanos(clock.newest.load(Ordering::Relaxed).saturating_sub(self.origin()))
            }
            Source::Simulated(_) => Stamp::default(),
        }
    }

    /// A stamp of the run on the ROS clock.
    #[must_use]
    pub fn to_ros(&self, run: Stamp) -> Stamp {
        Stamp::from_nanos(run.nanos.saturating_add(self.origin()))
    }

    /// A ROS stamp as the run's.
    #[must_use]
    pub fn to_run(&self, ros: Stamp) -> Stamp {
        Stamp::from_nanos(ros.nanos.saturating_sub(self.origin()))
    }

    /// A message's stamp as the run's.
    ///
    /// # Errors
    /// When the stamp is more than 1 s old or more than 0.1 s in the future: the clocks of the two computers differ.
    pub fn checked_to_run(&self, ros: Stamp) -> Result<Stamp, Invalid> {
        let run = self.to_run(ros);
        let age = self.now() - run;
        let (value, expected) = if age > MAX_AGE_S {
            (format!("{age:.3} s behind"), "at most 1 s behind")
        } else if age < -MAX_LEAD_S {
            (format!("{:.3} s ahead of", -age), "at most 0.1 s ahead of")
        } else {
            return Ok(run);
        };
        let clock =
            if matches!(self.source, Source::System { .. }) { "this computer's clock" } else { "/clock" };
        let remedy = "synchronise the clocks (chrony), or set use_sim_time if a simulator gives /clock";
        Err(Invalid::new("stamp", format!("{value} {clock}"), "", format!("{expected} it: {remedy}")))
    }

    /// The ROS time of the run's stamp 0 \[ns\].
    fn origin(&self) -> i64 {
        match &self.source {
            Source::System { at_start, .. } => *at_start,
            Source::Simulated(clock) => match clock.first.load(Ordering::Relaxed) {
                NOT_BEGUN => 0,
                first => first,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_go_to_the_run_and_back() {
        let clock = RosClock::system();
        let ros = clock.ros_now();
        assert_eq!(clock.to_ros(clock.checked_to_run(ros).unwrap()), ros);
        assert!(clock.to_run(ros).as_secs() < 1.0);
    }

    #[test]
    fn clocks_that_differ_are_named() {
        let clock = RosClock::system();
        let refused = |by: f64| clock.checked_to_run(clock.ros_now().after(by)).unwrap_err().to_string();
        assert!(refused(-31_536_000.0).starts_with("stamp is 31536000.00"), "{}", refused(-31_536_000.0));
        assert!(refused(-2.0).contains("s behind this computer's clock, expected at most 1 s behind it"));
        assert!(refused(60.0).contains("s ahead of this computer's clock"));
        assert!(clock.checked_to_run(Stamp::default()).is_err());
    }

    #[test]
    fn a_simulated_clock_begins_with_its_first_message_and_does_not_go_back() {
        let clock = RosClock::simulated();
        assert!(!clock.has_begun());
        clock.set(Stamp::from_nanos(5_000_000_000)).unwrap();
        clock.set(Stamp::from_nanos(7_500_000_000)).unwrap();
        assert_eq!(clock.now().as_secs(), 2.5);
        assert!(clock.checked_to_run(Stamp::from_nanos(7_400_000_000)).is_ok());
        assert!(clock.set(Stamp::from_nanos(0)).unwrap_err().to_string().starts_with("clock is 7.5 s back"));
        assert_eq!(clock.now().as_secs(), 2.5);
    }
}

//! Time stamps on the sensors' clock, in nanoseconds.

use serde::{Deserialize, Serialize};
use std::{fmt, ops::Sub};

/// A moment on the sensors' clock: nanoseconds since that clock's epoch.
///
/// Time is part of the data: no crate below the runtime reads a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Stamp {
    /// Nanoseconds since the epoch.
    pub nanos: i64,
}

impl Stamp {
    /// A stamp from nanoseconds since the epoch.
    pub const fn from_nanos(nanos: i64) -> Self {
        Self { nanos }
    }

    /// From seconds since the epoch, rounded to the nanosecond; `None` if not finite or out of range (292 years).
    pub fn from_secs(secs: f64) -> Option<Self> {
        let nanos = (secs * 1e9).round();
        (nanos.is_finite() && nanos.abs() < i64::MAX as f64).then_some(Self { nanos: nanos as i64 })
    }

    /// Seconds since the epoch. Loses digits below a microsecond for dates of our century.
    pub fn as_secs(self) -> f64 {
        self.nanos as f64 * 1e-9
    }

    /// The stamp `secs` seconds later (earlier when negative), rounded to the nanosecond, saturating.
    pub fn after(self, secs: f64) -> Self {
        Self { nanos: self.nanos.saturating_add((secs * 1e9).round() as i64) }
    }
}

/// Seconds from `earlier` to `self`, exact to the nanosecond.
#[expect(clippy::suspicious_arithmetic_impl, reason = "nanoseconds to seconds")]
impl Sub for Stamp {
    type Output = f64;

    fn sub(self, earlier: Self) -> f64 {
        self.nanos.saturating_sub(earlier.nanos) as f64 * 1e-9
    }
}

/// Seconds with nine digits, without rounding.
impl fmt::Display for Stamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.nanos < 0 { "-" } else { "" };
        let nanos = self.nanos.unsigned_abs();
        write!(f, "{sign}{}.{:09}", nanos / 1_000_000_000, nanos % 1_000_000_000)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_exact_and_display_keeps_every_digit() {
        let a = Stamp::from_nanos(1_305_031_229_528_748_000);
        assert_eq!(a.after(0.02) - a, 0.02);
        assert_eq!(a.to_string(), "1305031229.528748000");
        assert_eq!(Stamp::from_nanos(-1).to_string(), "-0.000000001");
        assert_eq!(Stamp::from_secs(f64::NAN), None);
    }
}
